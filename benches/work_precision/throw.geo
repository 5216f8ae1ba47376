// A block in the room that it is thrown through.
//
//   +---------------------------+  y = height
//   |   +-----+                 |
//   |   |block|      room       |     regions  block, room (a buffer)
//   |   +-----+                 |
//   +---------------------------+  y = 0
DefineConstant[
  side   = {1,    Min 1e-6, Name "Parameters/side"},   // of the block [m]
  left   = {1,    Min 1e-6, Name "Parameters/left"},   // room to the left and below [m]
  length = {6,    Min 1e-6, Name "Parameters/length"}, // of the room [m]
  height = {4,    Min 1e-6, Name "Parameters/height"}, // of the room [m]
  h      = {0.25, Min 1e-6, Name "Parameters/h"},      // size of the cells [m]
  quads  = {0, Choices{0, 1}, Name "Parameters/quads"} // 1: regular quadrilaterals
];
x[] = {0, left, left + side, length};
y[] = {0, left, left + side, height};
For j In {0:3}
  For i In {0:3}
    Point(1 + i + 4 * j) = {x[i], y[j], 0, h};
  EndFor
EndFor
For j In {0:3}
  For i In {0:2}
    Line(100 + i + 4 * j) = {1 + i + 4 * j, 2 + i + 4 * j};
    Transfinite Curve{100 + i + 4 * j} = Ceil((x[i + 1] - x[i]) / h - 1e-9) + 1;
    Line(200 + j + 4 * i) = {1 + j + 4 * i, 1 + j + 4 * (i + 1)};
    Transfinite Curve{200 + j + 4 * i} = Ceil((y[i + 1] - y[i]) / h - 1e-9) + 1;
  EndFor
EndFor
room[] = {};
For j In {0:2}
  For i In {0:2}
    k = 300 + i + 4 * j;
    Curve Loop(k) = {100 + i + 4 * j, 200 + i + 1 + 4 * j, -(100 + i + 4 * (j + 1)), -(200 + i + 4 * j)};
    Plane Surface(k) = {k};
    If (i != 1 || j != 1)
      room[] += k;
    EndIf
  EndFor
EndFor
If (quads)
  Transfinite Surface{:};
  Recombine Surface{:};
EndIf
Physical Surface("block") = {305};
Physical Surface("room") = room[];
