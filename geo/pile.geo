// A pile on soil, symmetric about x = 0 (the axis in axisymmetry), with a mesh of its own above the grid.
//
//          head
//         +----+
//         |pile|   side                         regions  clay_near, clay_far, water, pile
//  water  |    |_______________+                curves   head, axis, axis_far, pile_axis, shore, side, bottom
//   +.....(____)...............|....+ 0         points   tip
//   |        clay_near         |    |
//   |__________________________|    |
//   |           clay_far            |
//   +-------------------------------+
//                bottom
//
// Cells grow from h around the way of the pile to h * coarse at the far corners.
DefineConstant[
  radius = {0.5,   Min 1e-6, Name "Parameters/radius"},   // of the pile, or half its width [m]
  edge   = {0.1,   Min 1e-6, Name "Parameters/edge"},     // radius of the round edge of its base [m]
  length = {2,     Min 1e-6, Name "Parameters/length"},   // of the pile [m]
  depth  = {1.6,   Min 1e-6, Name "Parameters/depth"},    // it will be pushed to: cells are fine down to there [m]
  near_x = {7.5,   Min 1e-6, Name "Parameters/near_x"},   // width and depth of the near field [m]
  near_y = {5,     Min 1e-6, Name "Parameters/near_y"},
  far_x  = {15,    Min 1e-6, Name "Parameters/far_x"},    // width and depth of the whole [m]
  far_y  = {12.5,  Min 1e-6, Name "Parameters/far_y"},
  water  = {1.5,   Min 1e-6, Name "Parameters/water"},    // height of the water that soil may heave into [m]
  h      = {0.125, Min 1e-6, Name "Parameters/h"},        // size of the cells around the pile [m]
  coarse = {12,    Min 1,    Name "Parameters/coarse"}    // size at the far corners, in h
];
Point(1) = {0, -far_y, 0};
Point(2) = {far_x, -far_y, 0};
Point(3) = {far_x, 0, 0};
Point(4) = {near_x, 0, 0};
Point(5) = {near_x, -near_y, 0};
Point(6) = {0, -near_y, 0};
Point(7) = {0, 0, 0};
Point(8) = {near_x, water, 0};
Point(9) = {0, water, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {4, 7};
Line(8) = {7, 6};
Line(9) = {4, 8};
Line(10) = {8, 9};
Line(11) = {9, 7};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {7, 8, -5, -4};
Plane Surface(2) = {2};
Curve Loop(3) = {9, 10, 11, -7};
Plane Surface(3) = {3};

Point(11) = {0, 0, 0};
Point(12) = {radius - edge, 0, 0};
Point(13) = {radius - edge, edge, 0};
Point(14) = {radius, edge, 0};
Point(15) = {radius, length, 0};
Point(16) = {0, length, 0};
Line(21) = {11, 12};
Circle(22) = {12, 13, 14};
Line(23) = {14, 15};
Line(24) = {15, 16};
Line(25) = {16, 11};
Curve Loop(4) = {21, 22, 23, 24, 25};
Plane Surface(4) = {4};

// Fine in a box around the way of the pile, coarser with the distance from it.
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = 2.2 * radius;
Field[1].YMin = -depth - 1.6 * radius;
Field[1].YMax = 0.8 * radius;
Field[1].Thickness = 0.6 * far_y;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("clay_far") = {1};
Physical Surface("clay_near") = {2};
Physical Surface("water") = {3};
Physical Surface("pile") = {4};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2, 9};
Physical Curve("axis") = {6, 8, 11};
Physical Curve("pile_axis") = {25};
Physical Curve("head") = {24};
Physical Point("tip") = {11};
