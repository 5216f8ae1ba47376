// Half of a horizontal plate in clay, symmetric about x = 0. In axisymmetry the same section is a round plate.
//
//  |    air     |
//  +------------+ 0                  regions  clay, hole, air, plate
//  |            | side               curves   axis, side, bottom
//  +--+         | -cover
//  +--+  clay   |
//  +------------+ -cover - beneath
//     bottom
//
// The plate lies on the hole, which is part of the grid: soil may follow the plate into it. Cells are of size h along the way of the side of the
// plate, and grow with the distance from it to h * under in a box around the plate and its way, and to h * coarse farther out.
DefineConstant[
  half_width = {0.5, Min 1e-6, Name "Parameters/half_width"}, // B/2 or the radius [m]
  thickness  = {0.2, Min 1e-6, Name "Parameters/thickness"},  // of the plate [m]
  cover      = {4,   Min 1e-6, Name "Parameters/cover"},      // of clay above the plate [m]
  beneath    = {3,   Min 1e-6, Name "Parameters/beneath"},    // clay beneath the top of the plate [m]
  width      = {7,   Min 1e-6, Name "Parameters/width"},      // of the clay from the axis on [m]
  air        = {1,   Min 1e-6, Name "Parameters/air"},        // height that soil may heave into [m]
  way        = {0.5, Min 0, Name "Parameters/way"},           // that the plate will go upwards [m]
  edge       = {0,   Min 0, Name "Parameters/edge"},          // radius of its edges, 0: sharp [m]
  h          = {0.1, Min 1e-6, Name "Parameters/h"},          // size of the cells along the way of its side [m]
  under      = {1,   Min 1, Name "Parameters/under"},         // size in the box, in h
  coarse     = {4,   Min 1, Name "Parameters/coarse"}         // largest size, in h
];
depth = cover + beneath;
base = -cover - thickness;
Point(1) = {0, -depth, 0};
Point(2) = {width, -depth, 0};
Point(3) = {width, 0, 0};
Point(4) = {0, 0, 0};
Point(5) = {width, air, 0};
Point(6) = {0, air, 0};
Point(7) = {0, -cover, 0};
Point(10) = {0, base, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 7};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Line(11) = {10, 1};
Line(12) = {7, 10};

// The plate from the axis downwards and back, twice: as the edge of the clay and with a mesh of its own.
For k In {0:1}
  p = 20 + 20 * k;
  If (k == 0)
    first = 7;
    last = 10;
  Else
    first = 60;
    last = 61;
    Point(60) = {0, -cover, 0};
    Point(61) = {0, base, 0};
  EndIf
  If (edge > 0)
    Point(p) = {half_width - edge, -cover, 0};
    Point(p + 1) = {half_width - edge, -cover - edge, 0};
    Point(p + 2) = {half_width, -cover - edge, 0};
    Point(p + 3) = {half_width, base + edge, 0};
    Point(p + 4) = {half_width - edge, base + edge, 0};
    Point(p + 5) = {half_width - edge, base, 0};
    Line(p) = {first, p};
    Circle(p + 1) = {p, p + 1, p + 2};
    Line(p + 2) = {p + 2, p + 3};
    Circle(p + 3) = {p + 3, p + 4, p + 5};
    Line(p + 4) = {p + 5, last};
    outline~{k} = {p, p + 1, p + 2, p + 3, p + 4};
  Else
    Point(p) = {half_width, -cover, 0};
    Point(p + 1) = {half_width, base, 0};
    Line(p) = {first, p};
    Line(p + 1) = {p, p + 1};
    Line(p + 2) = {p + 1, last};
    outline~{k} = {p, p + 1, p + 2};
  EndIf
EndFor
Line(62) = {60, 61};
Curve Loop(1) = {1, 2, 3, 4, outline_0[], 11};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};
Curve Loop(3) = {outline_1[], -62};
Plane Surface(3) = {3};
Curve Loop(4) = {outline_0[], -12};
Plane Surface(4) = {4};

// The way of the side, and the distance from it.
Point(70) = {half_width, base, 0};
Point(71) = {half_width, -cover + way, 0};
Line(70) = {70, 71};
Field[2] = Distance;
Field[2].CurvesList = {70};
Field[2].Sampling = Ceil(2 * (thickness + way) / h);
Field[3] = Threshold;
Field[3].InField = 2;
Field[3].SizeMin = h;
Field[3].SizeMax = coarse * h;
Field[3].DistMin = 2 * h;
Field[3].DistMax = 2 * h + 5 * (coarse - 1) * h + 1e-3 * h;
Field[1] = Box;
Field[1].VIn = under * h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = 2 * half_width;
Field[1].YMin = base - half_width;
Field[1].YMax = -cover + half_width + way;
Field[1].Thickness = 3 * coarse * h;
Field[4] = Min;
Field[4].FieldsList = {1, 3};
Background Field = 4;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("clay") = {1};
Physical Surface("hole") = {4};
Physical Surface("air") = {2};
Physical Surface("plate") = {3};
Physical Curve("axis") = {4, 7, 11, 12};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};
