// Half of a strip footing on soil in two regions that share their nodes along a slanted line.
//
//   footing     surface
//   +====+---------+-----------+
//   |      near   /            | side
//   |            /             |         regions  near, far
//   +-----------+     far      |         curves   footing, surface, axis, side, bottom
//   |                          |
//   +--------------------------+
//             bottom
DefineConstant[
  h = {0.1, Min 1e-6, Name "Parameters/h"} // size of the cells at the edge of the footing [m]
];
Point(1) = {0, -5, 0, 8 * h};
Point(2) = {5, -5, 0, 8 * h};
Point(3) = {5, 0, 0, 8 * h};
Point(4) = {2.6, 0, 0, 4 * h};
Point(5) = {1, 0, 0, h};
Point(6) = {0, 0, 0, 2 * h};
Point(7) = {0, -1.3, 0, 4 * h};
Point(8) = {1.7, -1.1, 0, 4 * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 1};
Line(8) = {7, 8};
Line(9) = {8, 4};
Curve Loop(1) = {4, 5, 6, 8, 9};
Plane Surface(1) = {1};
Curve Loop(2) = {1, 2, 3, -9, -8, 7};
Plane Surface(2) = {2};
Physical Surface("near") = {1};
Physical Surface("far") = {2};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2};
Physical Curve("surface") = {3, 4};
Physical Curve("footing") = {5};
Physical Curve("axis") = {6, 7};
