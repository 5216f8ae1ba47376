// Soil under a plate with a mesh of its own: as wide as the soil, or a short one with round edges in its middle.
DefineConstant[
  width = {2, Name "Parameters/width"}, depth = {1, Name "Parameters/depth"}, air = {0.4, Name "Parameters/air"},
  plate = {2, Name "Parameters/plate"}, left = {0, Name "Parameters/left"}, edge = {0, Name "Parameters/edge"},
  thick = {0.3, Name "Parameters/thick"}, h = {0.2, Name "Parameters/h"}, hp = {0.13, Name "Parameters/hp"}
];
Point(1) = {0, -depth, 0, h}; Point(2) = {width, -depth, 0, h};
Point(3) = {width, 0, 0, h}; Point(4) = {0, 0, 0, h};
Point(5) = {width, air, 0, h}; Point(6) = {0, air, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
r = edge;
If (r > 0)
  Point(11) = {left + r, 0, 0, hp}; Point(12) = {left + plate - r, 0, 0, hp};
  Point(13) = {left + plate - r, r, 0, hp}; Point(14) = {left + plate, r, 0, hp};
  Point(15) = {left + plate, thick, 0, hp}; Point(16) = {left, thick, 0, hp};
  Point(17) = {left, r, 0, hp}; Point(18) = {left + r, r, 0, hp};
  Line(11) = {11, 12}; Circle(12) = {12, 13, 14}; Line(13) = {14, 15}; Line(14) = {15, 16};
  Line(15) = {16, 17}; Circle(16) = {17, 18, 11};
  Curve Loop(3) = {11, 12, 13, 14, 15, 16};
Else
  Point(11) = {left, 0, 0, hp}; Point(12) = {left + plate, 0, 0, hp};
  Point(13) = {left + plate, thick, 0, hp}; Point(14) = {left, thick, 0, hp};
  Line(11) = {11, 12}; Line(13) = {12, 13}; Line(14) = {13, 14}; Line(15) = {14, 11};
  Curve Loop(3) = {11, 13, 14, 15};
EndIf
Plane Surface(3) = {3};
Physical Surface("soil") = {1}; Physical Surface("air") = {2}; Physical Surface("plate") = {3};
Physical Curve("bottom") = {1}; Physical Curve("side") = {2, 4, 5, 7};
Physical Curve("top") = {14}; Physical Curve("ends") = {13, 15};
