// Layers of soil in one column of cells, with its sides apart.
DefineConstant[ h = {1, Name "Parameters/h"} ];
y[] = {-20, -8, 0};
For i In {0:2}
  Point(10 + i) = {0, y[i], 0, h};  Point(20 + i) = {h, y[i], 0, h};  Line(30 + i) = {10 + i, 20 + i};
  Transfinite Curve {30 + i} = 2;
EndFor
For i In {0:1}
  Line(40 + i) = {10 + i, 11 + i};  Line(50 + i) = {20 + i, 21 + i};
  Transfinite Curve {40 + i, 50 + i} = Round((y[i + 1] - y[i])/h) + 1;
  Curve Loop(60 + i) = {30 + i, 50 + i, -(31 + i), -(40 + i)};  Plane Surface(60 + i) = {60 + i};
  Transfinite Surface {60 + i};  Recombine Surface {60 + i};
EndFor
Physical Surface("sand") = {60};  Physical Surface("clay") = {61};
Physical Curve("base") = {30};    Physical Curve("top") = {32};
Physical Curve("left") = {40, 41};  Physical Curve("right") = {50, 51};
