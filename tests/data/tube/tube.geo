// An open tube through soil, in axisymmetry: a section off the axis, with a mesh of its own in a slot of the grid.
DefineConstant[
  inner = {0.5, Name "Parameters/inner"}, thick = {0.1, Name "Parameters/thick"}, width = {2, Name "Parameters/width"},
  depth = {1, Name "Parameters/depth"}, air = {0.4, Name "Parameters/air"},
  h = {0.1, Name "Parameters/h"}, hp = {0.07, Name "Parameters/hp"}
];
outer = inner + thick;
Point(1) = {0, -depth, 0, h}; Point(2) = {inner, -depth, 0, h}; Point(3) = {outer, -depth, 0, h}; Point(4) = {width, -depth, 0, h};
Point(5) = {width, 0, 0, h}; Point(6) = {outer, 0, 0, h}; Point(7) = {inner, 0, 0, h}; Point(8) = {0, 0, 0, h};
Point(9) = {width, air, 0, h}; Point(10) = {0, air, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8};
Line(8) = {8, 1}; Line(9) = {2, 7}; Line(10) = {3, 6}; Line(11) = {5, 9}; Line(12) = {9, 10}; Line(13) = {10, 8};
Curve Loop(1) = {1, 9, 7, 8}; Plane Surface(1) = {1};
Curve Loop(2) = {3, 4, 5, -10}; Plane Surface(2) = {2};
Curve Loop(3) = {2, 10, 6, -9}; Plane Surface(3) = {3};
Curve Loop(4) = {-5, 11, 12, 13, -7, -6}; Plane Surface(4) = {4};
Point(11) = {inner, -depth, 0, hp}; Point(12) = {outer, -depth, 0, hp};
Point(13) = {outer, air / 2, 0, hp}; Point(14) = {inner, air / 2, 0, hp};
Line(21) = {11, 12}; Line(22) = {12, 13}; Line(23) = {13, 14}; Line(24) = {14, 11};
Curve Loop(5) = {21, 22, 23, 24}; Plane Surface(5) = {5};
Physical Surface("soil") = {1, 2}; Physical Surface("slot") = {3}; Physical Surface("air") = {4}; Physical Surface("tube") = {5};
Physical Curve("bottom") = {1, 2, 3}; Physical Curve("axis") = {8, 13}; Physical Curve("side") = {4, 11}; Physical Curve("head") = {23};
