// Soil under a plate with a mesh of its own, and air beside and above: a grid of rectangles along the axes.
//
//   +--------------+------------+  y = air
//   |              |            |
//   |     air      |    air     |       a plate lies on the soil from x = 0 to `plate`
//   +=======+------+------------+  y = 0
//   |    soil      |    air     |
//   +--------------+------------+  y = -depth
DefineConstant[
  width = {2, Name "Parameters/width"}, depth = {1, Name "Parameters/depth"}, air = {0.5, Name "Parameters/air"},
  room = {1, Name "Parameters/room"}, plate = {2, Name "Parameters/plate"}, thick = {0.3, Name "Parameters/thick"},
  h = {0.25, Name "Parameters/h"}, hp = {0.17, Name "Parameters/hp"}
];
Point(1) = {0, -depth, 0}; Point(2) = {width, -depth, 0}; Point(3) = {width, 0, 0}; Point(4) = {0, 0, 0};
Point(5) = {width, air, 0}; Point(6) = {0, air, 0};
Point(7) = {width + room, -depth, 0}; Point(8) = {width + room, 0, 0}; Point(9) = {width + room, air, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};
Line(8) = {2, 7}; Line(9) = {7, 8}; Line(10) = {8, 3}; Line(11) = {8, 9}; Line(12) = {9, 5};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
Curve Loop(3) = {8, 9, 10, -2}; Plane Surface(3) = {3};
Curve Loop(4) = {-10, 11, 12, -5}; Plane Surface(4) = {4};
Transfinite Curve{1, 3, 6} = Ceil(width / h - 1e-9) + 1;
Transfinite Curve{2, 4, 9} = Ceil(depth / h - 1e-9) + 1;
Transfinite Curve{5, 7, 11} = Ceil(air / h - 1e-9) + 1;
Transfinite Curve{8, 10, 12} = Ceil(room / h - 1e-9) + 1;
Transfinite Surface{1, 2, 3, 4};
Recombine Surface{1, 2, 3, 4};
Point(11) = {0, 0, 0, hp}; Point(12) = {plate, 0, 0, hp}; Point(13) = {plate, thick, 0, hp}; Point(14) = {0, thick, 0, hp};
Line(21) = {11, 12}; Line(22) = {12, 13}; Line(23) = {13, 14}; Line(24) = {14, 11};
Curve Loop(5) = {21, 22, 23, 24}; Plane Surface(5) = {5};
Physical Surface("soil") = {1}; Physical Surface("air") = {2, 3, 4}; Physical Surface("plate") = {5};
Physical Curve("bottom") = {1, 8}; Physical Curve("axis") = {4, 7}; Physical Curve("end") = {9, 11};
Physical Curve("top") = {23}; Physical Curve("face") = {2};
