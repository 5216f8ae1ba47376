// A column of rows of cells with its sides apart; its base may be inclined.
DefineConstant[
  width = {1, Name "Parameters/width"}, height = {10, Name "Parameters/height"}, h = {1, Name "Parameters/h"},
  slope = {0, Name "Parameters/slope"}
];
Point(1) = {0, 0, 0, h}; Point(2) = {width, width*slope, 0, h};
Point(3) = {width, height + width*slope, 0, h}; Point(4) = {0, height, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve {1, 3} = Round(width/h) + 1;
Transfinite Curve {2, 4} = Round(height/h) + 1;
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("soil") = {1};
Physical Curve("base") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
