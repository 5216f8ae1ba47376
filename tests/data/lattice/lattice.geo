// Soil under a plate as tests/data/plate/plate.geo has it, on a rectangular grid of quadrangles with lines that may come closer upwards.
DefineConstant[
  width = {2, Name "Parameters/width"}, nx = {8, Name "Parameters/nx"}, ny = {5, Name "Parameters/ny"},
  na = {2, Name "Parameters/na"}, ratio = {1, Name "Parameters/ratio"}, quads = {1, Name "Parameters/quads"},
  plate = {2, Name "Parameters/plate"}, left = {0, Name "Parameters/left"}, hp = {0.13, Name "Parameters/hp"}
];
Point(1) = {0, -1, 0}; Point(2) = {width, -1, 0}; Point(3) = {width, 0, 0}; Point(4) = {0, 0, 0};
Point(5) = {width, 0.4, 0}; Point(6) = {0, 0.4, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
Transfinite Curve {1, 3, 6} = nx + 1;
Transfinite Curve {2} = ny + 1 Using Progression 1 / ratio;
Transfinite Curve {4} = ny + 1 Using Progression ratio;
Transfinite Curve {5, 7} = na + 1;
Transfinite Surface {1, 2};
If (quads)
  Recombine Surface {1, 2};
EndIf
Physical Surface("soil") = {1}; Physical Surface("air") = {2};
Physical Curve("bottom") = {1}; Physical Curve("side") = {2, 4, 5, 7}; Physical Curve("surface") = {3};
If (plate)
  Point(11) = {left, 0, 0, hp}; Point(12) = {left + plate, 0, 0, hp};
  Point(13) = {left + plate, 0.3, 0, hp}; Point(14) = {left, 0.3, 0, hp};
  Line(11) = {11, 12}; Line(13) = {12, 13}; Line(14) = {13, 14}; Line(15) = {14, 11};
  Curve Loop(3) = {11, 13, 14, 15}; Plane Surface(3) = {3};
  Physical Surface("plate") = {3}; Physical Curve("top") = {14};
EndIf
