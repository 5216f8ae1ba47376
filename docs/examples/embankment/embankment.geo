// Half of an embankment on clay 4 m deep: three lifts of 1 m, 4 m wide at their base and with slopes of 1:1.
DefineConstant[ h = {0.5, Min 0.05, Name "Parameters/h"} ];
DefineConstant[ side = {1, Choices{-1, 1}, Name "Parameters/side"} ];
w = 12;  d = 4;  b = 5;
Point(1) = {0, -d, 0, 2*h};  Point(2) = {side*w, -d, 0, 2*h};  Point(3) = {side*w, 0, 0, 2*h};  Point(4) = {side*w, 3.5, 0, 2*h};  Point(5) = {0, 3.5, 0, h};
For i In {0:3}
  Point(10 + i) = {0, i, 0, h};  Point(20 + i) = {side*(b - i), i, 0, h};  Line(30 + i) = {10 + i, 20 + i};
EndFor
For i In {0:2}
  Line(40 + i) = {10 + i, 11 + i};  Line(50 + i) = {20 + i, 21 + i};
  Curve Loop(60 + i) = {30 + i, 50 + i, -(31 + i), -(40 + i)};  Plane Surface(60 + i) = {60 + i};
EndFor
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 20};  Line(4) = {10, 1};  Line(5) = {3, 4};  Line(6) = {4, 5};  Line(7) = {5, 13};
Curve Loop(1) = {1, 2, 3, -30, 4};  Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7, 33, -52, -51, -50};  Plane Surface(2) = {2};
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("lift1") = {60};
Physical Surface("lift2") = {61};
Physical Surface("lift3") = {62};
Physical Curve("bottom") = {1};
Physical Curve("sides") = {2, 4, 5, 7, 40, 41, 42};
Physical Curve("ground") = {30};
