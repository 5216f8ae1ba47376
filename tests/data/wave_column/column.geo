// A column 1 m wide and 10 m high under 1 m of air.
DefineConstant[ h = {0.5, Min 0.05, Name "Parameters/h"} ];
y[] = {0, 10, 11};
For i In {0:2}
  Point(10 + i) = {0, y[i], 0, h};  Point(20 + i) = {1, y[i], 0, h};  Line(30 + i) = {10 + i, 20 + i};
  Transfinite Curve {30 + i} = Round(1/h) + 1;
EndFor
For i In {0:1}
  Line(40 + i) = {10 + i, 11 + i};  Line(50 + i) = {20 + i, 21 + i};
  Transfinite Curve {40 + i, 50 + i} = Round((y[i + 1] - y[i])/h) + 1;
  Curve Loop(60 + i) = {30 + i, 50 + i, -(31 + i), -(40 + i)};  Plane Surface(60 + i) = {60 + i};
  Transfinite Surface {60 + i};  Recombine Surface {60 + i};
EndFor
Physical Surface("soil") = {60};
Physical Surface("air") = {61};
Physical Curve("bottom") = {30};
Physical Curve("top") = {31};
Physical Curve("sides") = {40, 41, 50, 51};
