// Half of a punch with a mesh of its own on soil, symmetric about x = 0. In axisymmetry the same section is a cylinder.
//
//        head
//       +-----+                                  regions  soil, air, punch
//       |punch|    air                           curves   head, axis, surface, side, bottom
//       +-----+......................+ 0         points   edge
//     a |                            | s
//     x |            soil            | i
//     i |                            | d
//     s +----------------------------+ e
//                  bottom
//
// The mesh of the soil has no node at the edge of the punch. Cells are h there, at all depths that it passes, h * under in the
// mechanism and h * coarse far from it.
DefineConstant[
  half_width = {1,    Min 1e-6, Name "Parameters/half_width"}, // B/2 or the radius [m]
  edge       = {0,    Min 0,    Name "Parameters/edge"},       // radius of the edge, 0: sharp [m]
  way        = {0,    Min 0,    Name "Parameters/way"},        // depth that the punch is pushed to [m]
  height     = {0.5,  Min 1e-6, Name "Parameters/height"},     // of the punch beside the way [m]
  width      = {5,    Min 1e-6, Name "Parameters/width"},      // of the section, in half_width
  depth      = {5,    Min 1e-6, Name "Parameters/depth"},      // of the section below the way, in half_width
  air        = {0.5,  Min 1e-6, Name "Parameters/air"},        // height of the room above the soil [m]
  h          = {0.05, Min 1e-6, Name "Parameters/h"},          // size of the cells at the edge [m]
  under      = {2,    Min 1,    Name "Parameters/under"},      // size in the mechanism, in h
  coarse     = {12,   Min 1,    Name "Parameters/coarse"}      // size far from it, in h
];
b = half_width;
low = -way - depth * b;
Point(1) = {0, low, 0};
Point(2) = {width * b, low, 0};
Point(3) = {width * b, 0, 0};
Point(4) = {0, 0, 0};
Point(5) = {width * b, air, 0};
Point(6) = {0, air, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};

top = way + height;
Point(11) = {0, 0, 0};
Point(12) = {b - edge, 0, 0};
Point(15) = {b, top, 0};
Point(16) = {0, top, 0};
Line(11) = {11, 12};
Line(14) = {15, 16};
Line(15) = {16, 11};
If (edge > 0)
  Point(13) = {b - edge, edge, 0};
  Point(14) = {b, edge, 0};
  Circle(12) = {12, 13, 14};
  Line(13) = {14, 15};
  Curve Loop(3) = {11, 12, 13, 14, 15};
Else
  Line(13) = {12, 15};
  Curve Loop(3) = {11, 13, 14, 15};
EndIf
Plane Surface(3) = {3};

// The way of the edge, and the distance from it.
Point(21) = {b, 0, 0};
Point(22) = {b, -way - 1e-3 * b, 0};
Line(21) = {21, 22};
Field[1] = Distance;
Field[1].CurvesList = {21};
Field[1].Sampling = Ceil(2 * (way + b) / h);
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = h;
Field[2].SizeMax = coarse * h;
Field[2].DistMin = 2 * h;
Field[2].DistMax = 2 * h + 5 * (coarse - 1) * h;
Field[3] = Box;
Field[3].VIn = under * h;
Field[3].VOut = coarse * h;
Field[3].XMin = -b;
Field[3].XMax = 2.4 * b;
Field[3].YMin = -way - 1.4 * b;
Field[3].YMax = 2 * b + way;
Field[3].Thickness = 5 * (coarse - under + 0.1) * h;
Field[4] = Min;
Field[4].FieldsList = {2, 3};
Background Field = 4;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Surface("punch") = {3};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2, 5};
Physical Curve("surface") = {3};
Physical Curve("axis") = {4, 7};
Physical Curve("head") = {14};
Physical Point("edge") = {12};
