// A pipe on a seabed that is jetted into a trench beneath it: half of it, beside its plane of symmetry.
//
//     water  |   side
//  +)--+-----+ 0                     regions  fill, clay, water, pipe
//  |) pipe   |                       curves   axis, side, bottom
//  |fill|    |
//  |____|    | -trench
//  |  clay   |
//  +---------+ -depth
//    bottom
//
// Cells are of size h in the fill and grow with the distance from it, to h * coarse at most.
DefineConstant[
  diameter = {0.4, Min 1e-6, Name "Parameters/diameter"}, // of the pipe [m]
  trench   = {1.5, Min 1e-6, Name "Parameters/trench"},   // depth of the fill [m]
  half     = {1,   Min 1e-6, Name "Parameters/half"},     // half of its width [m]
  beneath  = {1,   Min 1e-6, Name "Parameters/beneath"},  // clay beneath it [m]
  aside    = {2,   Min 1e-6, Name "Parameters/aside"},    // clay beside it [m]
  water    = {0.4, Min 1e-6, Name "Parameters/water"},    // height that soil may heave into [m]
  h        = {0.06, Min 1e-6, Name "Parameters/h"},       // size of the cells in the fill [m]
  coarse   = {5,   Min 1, Name "Parameters/coarse"}       // largest size, in h
];
depth = trench + beneath;
width = half + aside;
radius = diameter / 2;
Point(1) = {0, -depth, 0};
Point(2) = {width, -depth, 0};
Point(3) = {width, 0, 0};
Point(4) = {half, 0, 0};
Point(5) = {0, 0, 0};
Point(6) = {0, -trench, 0};
Point(7) = {half, -trench, 0};
Point(8) = {width, water, 0};
Point(9) = {0, water, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {6, 7};
Line(8) = {7, 4};
Line(9) = {3, 8};
Line(10) = {8, 9};
Line(15) = {9, 5};
Curve Loop(1) = {1, 2, 3, -8, -7, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {7, 8, 4, 5};
Plane Surface(2) = {2};
Curve Loop(3) = {-4, -3, 9, 10, 15};
Plane Surface(3) = {3};
Point(11) = {0, 0, 0};
Point(12) = {radius, radius, 0};
Point(13) = {0, 2 * radius, 0};
Point(14) = {0, radius, 0};
Circle(11) = {11, 14, 12};
Circle(12) = {12, 14, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(4) = {11, 12, 13, 14};
Plane Surface(4) = {4};
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = half;
Field[1].YMin = -trench;
Field[1].YMax = water;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("clay") = {1};
Physical Surface("fill") = {2};
Physical Surface("water") = {3};
Physical Surface("pipe") = {4};
Physical Curve("axis") = {5, 6, 15};
Physical Curve("side") = {2, 9};
Physical Curve("bottom") = {1};
