// Half of a footing on soil, to the right of its axis. In plane strain it is a strip, in axisymmetry it is circular.
//
//   footing
//  +-------+           air
//  +-------+---------------------------+ 0        regions  soil, air, footing; point  top_edge (of the footing)
//  |                                   |          curves   axis, side, bottom
//  | axis         soil                 | side
//  |                                   |
//  +-----------------------------------+ -depth * half_width
//                bottom
//
// The footing has a mesh of its own, which lies over the cells of the soil. `air` are empty cells that soil may heave into.
// Gmsh shows all this, and its numbers may be changed there: gmsh footing.geo
DefineConstant[
  half_width = {1,    Min 1e-6, Name "Parameters/half_width"}, // B/2, or the radius [m]
  height     = {0.5,  Min 1e-6, Name "Parameters/height"},     // of the footing [m]
  width      = {5,    Min 2.5,  Name "Parameters/width"},      // of the soil, in half_width
  depth      = {5,    Min 1.5,  Name "Parameters/depth"},      // of the soil, in half_width
  air        = {0.5,  Min 1e-6, Name "Parameters/air"},        // height of the room above the soil [m]
  h          = {0.05, Min 1e-6, Name "Parameters/h"},          // size of the cells at the edge of the footing [m]
  under      = {2,    Min 1,    Name "Parameters/under"},      // size in the mechanism around it, in h
  coarse     = {12,   Min 1,    Name "Parameters/coarse"}      // size at the far corners, in h
];
b = half_width;

// Soil, and the air above it.
Point(1) = {0, -depth * b, 0};
Point(2) = {width * b, -depth * b, 0};
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

// The footing.
Point(11) = {0, 0, 0};
Point(12) = {b, 0, 0};
Point(13) = {b, height, 0};
Point(14) = {0, height, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};

// Sizes of cells: field 2 grows from h with the distance from the edge of the footing, where the stress is singular; field 3 is
// h * under in a box around the mechanism; the smaller of both counts.
Point(21) = {b, 0, 0};
Field[1] = Distance;
Field[1].PointsList = {21};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = h;
Field[2].SizeMax = coarse * h;
Field[2].DistMin = 2 * h;
Field[2].DistMax = 2 * h + 5 * coarse * h;
Field[3] = Box;
Field[3].VIn = under * h;
Field[3].VOut = coarse * h;
Field[3].XMin = -b;
Field[3].XMax = 2.4 * b;
Field[3].YMin = -1.4 * b;
Field[3].YMax = b;
Field[3].Thickness = 5 * coarse * h;
Field[4] = Min;
Field[4].FieldsList = {2, 3};
Background Field = 4;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

// What case.yaml calls them.
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Surface("footing") = {3};
Physical Curve("axis") = {4, 7};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};
Physical Point("top_edge") = {13};
