// A pipe on a seabed, with a mesh of its own above the grid.
//
//            ____
//      water/    \                                       regions  clay_near, clay_far, water, pipe
//  +.......| core |.............................+        curves   core, shore, side, bottom
//  |        \____/   -> it goes `way` this way  |        point    centre
//  +----+......................................+----+ 0
//  |    |              clay_near               |    |
//  |    |______________________________________|    |
//  |                   clay_far                     |
//  +------------------------------------------------+
//                       bottom
//
// Cells are of size h around the way of the pipe and grow with the distance from it, to h * coarse at most.
DefineConstant[
  diameter = {0.8,  Min 1e-6, Name "Parameters/diameter"},  // of the pipe, [m]
  placed   = {0,    Min 0,    Name "Parameters/placed"},    // depth that the pipe begins at, in a trench of its shape [m]
  way      = {5.6,  Min 1e-6, Name "Parameters/way"},       // that it will be pulled [m]
  deep     = {0.35, Min 1e-6, Name "Parameters/deep"},      // cells are fine down to there [m]
  heave    = {0.4,  Min 1e-6, Name "Parameters/heave"},     // and up to there [m]
  aside    = {1.6,  Min 1e-6, Name "Parameters/aside"},     // near field before and behind the way [m]
  near_y   = {1.2,  Min 1e-6, Name "Parameters/near_y"},    // depth of the near field [m]
  far      = {1.6,  Min 1e-6, Name "Parameters/far"},       // width of the far field beside the near one, and below it [m]
  water    = {1,    Min 1e-6, Name "Parameters/water"},     // height of the water that soil may heave into [m]
  h        = {0.1,  Min 1e-6, Name "Parameters/h"},         // size of the cells around the pipe [m]
  coarse   = {5,    Min 1,    Name "Parameters/coarse"}     // largest size, in h
];
left = -aside;
right = way + aside;
Point(1) = {left - far, -near_y - far, 0};
Point(2) = {right + far, -near_y - far, 0};
Point(3) = {right + far, 0, 0};
Point(4) = {right, 0, 0};
Point(5) = {right, -near_y, 0};
Point(6) = {left, -near_y, 0};
Point(7) = {left, 0, 0};
Point(8) = {left - far, 0, 0};
Point(9) = {right, water, 0};
Point(10) = {left, water, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 1};
radius = diameter / 2;
height = radius - placed; // of the centre
If (placed > 0)
  half = Sqrt(radius^2 - height^2);
  Point(21) = {half, 0, 0};
  Point(22) = {0, -placed, 0};
  Point(23) = {-half, 0, 0};
  Point(24) = {0, height, 0};
  Line(31) = {4, 21};
  Circle(32) = {21, 24, 22};
  Circle(33) = {22, 24, 23};
  Line(34) = {23, 7};
  seabed[] = {31, 32, 33, 34};
Else
  Line(31) = {4, 7};
  seabed[] = {31};
EndIf
Line(10) = {4, 9};
Line(11) = {9, 10};
Line(12) = {10, 7};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8};
Plane Surface(1) = {1};
Curve Loop(2) = {seabed[], -6, -5, -4};
Plane Surface(2) = {2};
Curve Loop(3) = {seabed[], -12, -11, -10};
Plane Surface(3) = {3};

Point(11) = {0, height, 0};
Point(12) = {0, height - radius, 0};
Point(13) = {radius, height, 0};
Point(14) = {0, height + radius, 0};
Point(15) = {-radius, height, 0};
Point(16) = {0, height - radius / 2, 0};
Point(17) = {0, height + radius / 2, 0};
Circle(21) = {12, 11, 13};
Circle(22) = {13, 11, 14};
Circle(23) = {14, 11, 15};
Circle(24) = {15, 11, 12};
Line(25) = {16, 11};
Line(26) = {11, 17};
Curve Loop(4) = {21, 22, 23, 24};
Plane Surface(4) = {4};
Curve{25, 26} In Surface{4};

// Fine in a box around the way of the pipe, coarser with the distance from it.
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1.2 * radius;
Field[1].XMax = way + 2.5 * radius;
Field[1].YMin = -deep;
Field[1].YMax = heave;
Field[1].Thickness = 2 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("clay_far") = {1};
Physical Surface("clay_near") = {2};
Physical Surface("water") = {3};
Physical Surface("pipe") = {4};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2, 8, 10, 12};
Physical Curve("core") = {25, 26};
Physical Point("centre") = {11};
