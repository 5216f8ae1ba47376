// Ground from which a vertical cut, 5 m high, is dug in four lifts, with small cells at its toe.
DefineConstant[ h = {0.35, Min 0.05, Name "Parameters/h"} ];
DefineConstant[ toe = {0.15, Min 0.005, Name "Parameters/toe"} ];
H = 5;  d = 2.5;  l = 10;  r = 15;
Point(1) = {-l, -d, 0, 3*h};  Point(2) = {r, -d, 0, 3*h};  Point(3) = {-l, H, 0, 3*h};  Point(4) = {-l, H + 1, 0, 3*h};  Point(5) = {r, H + 1, 0, 3*h};
For i In {0:4}
  Point(10 + i) = {0, i*H/4, 0, h};  Point(20 + i) = {r, i*H/4, 0, 3*h};  Line(30 + i) = {10 + i, 20 + i};
EndFor
MeshSize {10} = toe*h;
For i In {1:4}
  Line(40 + i) = {9 + i, 10 + i};  Line(50 + i) = {19 + i, 20 + i};
  Curve Loop(i) = {29 + i, 50 + i, -(30 + i), -(40 + i)};  Plane Surface(i) = {i};
EndFor
Line(1) = {3, 1};  Line(2) = {1, 2};  Line(3) = {2, 20};  Line(4) = {14, 3};  Line(5) = {24, 5};  Line(6) = {5, 4};  Line(7) = {4, 3};
Curve Loop(5) = {1, 2, 3, -30, 41, 42, 43, 44, 4};  Plane Surface(5) = {5};
Curve Loop(6) = {-4, 34, 5, 6, 7};  Plane Surface(6) = {6};
Physical Surface("clay") = {5};
Physical Surface("lift1") = {4};
Physical Surface("lift2") = {3};
Physical Surface("lift3") = {2};
Physical Surface("lift4") = {1};
Physical Surface("air") = {6};
Physical Curve("bottom") = {2};
Physical Curve("sides") = {1, 3, 5, 7, 51, 52, 53, 54};
