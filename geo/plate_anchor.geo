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
// The plate lies on the hole, which is part of the grid: soil may follow the plate into it. Cells are of size h in a box around the plate
// and its way and grow with the distance from it, to h * coarse at most.
DefineConstant[
  half_width = {0.5, Min 1e-6, Name "Parameters/half_width"}, // B/2 or the radius [m]
  thickness  = {0.2, Min 1e-6, Name "Parameters/thickness"},  // of the plate [m]
  cover      = {4,   Min 1e-6, Name "Parameters/cover"},      // of clay above the plate [m]
  beneath    = {3,   Min 1e-6, Name "Parameters/beneath"},    // clay beneath the top of the plate [m]
  width      = {7,   Min 1e-6, Name "Parameters/width"},      // of the clay from the axis on [m]
  air        = {1,   Min 1e-6, Name "Parameters/air"},        // height that soil may heave into [m]
  way        = {0.5, Min 0, Name "Parameters/way"},           // that the plate will go upwards [m]
  h          = {0.1, Min 1e-6, Name "Parameters/h"},          // size of the cells around the plate [m]
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
Point(8) = {half_width, -cover, 0};
Point(9) = {half_width, base, 0};
Point(10) = {0, base, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 7};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Line(8) = {7, 8};
Line(9) = {8, 9};
Line(10) = {9, 10};
Line(11) = {10, 1};
Line(12) = {7, 10};
Curve Loop(1) = {1, 2, 3, 4, 8, 9, 10, 11};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};
Curve Loop(4) = {8, 9, 10, -12};
Plane Surface(4) = {4};
Point(11) = {0, base, 0};
Point(12) = {half_width, base, 0};
Point(13) = {half_width, -cover, 0};
Point(14) = {0, -cover, 0};
Line(21) = {11, 12};
Line(22) = {12, 13};
Line(23) = {13, 14};
Line(24) = {14, 11};
Curve Loop(3) = {21, 22, 23, 24};
Plane Surface(3) = {3};
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = 2 * half_width;
Field[1].YMin = base - half_width;
Field[1].YMax = -cover + half_width + way;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("clay") = {1};
Physical Surface("hole") = {4};
Physical Surface("air") = {2};
Physical Surface("plate") = {3};
Physical Curve("axis") = {4, 7, 11, 12};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};
