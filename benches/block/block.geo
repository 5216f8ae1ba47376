// A block on a smooth floor, with room to spread to the right; half of a symmetric problem.
//
//   +---------+ - - - - - +  y = side
//   |  block  |   room    |          regions  block, room (a buffer: cells without points)
//   +---------+-----------+  y = 0   curves   bottom, left, right
//
// Every rectangle is halved into two triangles: 2 nx ny = 6400 cells in the block.
side = 8;   // [m]
DefineConstant[
  nx = {64, Min 1, Name "Parameters/nx"},  // rectangles along the block
  ny = {50, Min 1, Name "Parameters/ny"}   // and over its height
];
Point(1) = {0, 0, 0};
Point(2) = {side, 0, 0};
Point(3) = {2 * side, 0, 0};
Point(4) = {2 * side, side, 0};
Point(5) = {side, side, 0};
Point(6) = {0, side, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(2) = {2};
Transfinite Curve{1, 2, 4, 5} = nx + 1;
Transfinite Curve{3, 6, 7} = ny + 1;
Transfinite Surface{1} Alternate;
Transfinite Surface{2} Alternate;
Physical Surface("block") = {1};
Physical Surface("room") = {2};
Physical Curve("bottom") = {1, 2};
Physical Curve("right") = {3};
Physical Curve("left") = {6};
