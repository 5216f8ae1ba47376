// A column 1 m wide: ground 2 m deep, three lifts of 1 m above it, air.
DefineConstant[ h = {0.5, Min 0.05, Name "Parameters/h"} ];
DefineConstant[ quads = {1, Choices{0, 1}, Name "Parameters/quads"} ];
y[] = {-2, 0, 1, 2, 3, 4};
For i In {0:5}
  Point(10 + i) = {0, y[i], 0, h};  Point(20 + i) = {1, y[i], 0, h};  Line(30 + i) = {10 + i, 20 + i};
EndFor
For i In {0:4}
  Line(40 + i) = {10 + i, 11 + i};  Line(50 + i) = {20 + i, 21 + i};
  Curve Loop(60 + i) = {30 + i, 50 + i, -(31 + i), -(40 + i)};  Plane Surface(60 + i) = {60 + i};
EndFor
If (quads)
  For i In {0:5}
    Transfinite Curve {30 + i} = Round(1/h) + 1;
  EndFor
  For i In {0:4}
    Transfinite Curve {40 + i, 50 + i} = Round((y[i + 1] - y[i])/h) + 1;  Transfinite Surface {60 + i};  Recombine Surface {60 + i};
  EndFor
EndIf
Physical Surface("ground") = {60};
Physical Surface("lift1") = {61};
Physical Surface("lift2") = {62};
Physical Surface("lift3") = {63};
Physical Surface("air") = {64};
Physical Curve("bottom") = {30};
Physical Curve("sides") = {40:44, 50:54};
Physical Curve("top") = {31};
