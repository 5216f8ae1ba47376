// Ground of one thickness along a slope, on cells that are mirrored with it.
DefineConstant[ tan = {0.25, Name "Parameters/tan"}, deep = {4, Name "Parameters/deep"}, length = {48, Name "Parameters/length"} ];
rise = length * tan;
Point(1) = {0, 0, 0};  Point(2) = {length, rise, 0};  Point(3) = {length, rise + deep, 0};  Point(4) = {0, deep, 0};
Point(5) = {length, rise + deep + 1, 0};  Point(6) = {0, deep + 1, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Line(5) = {3, 5};  Line(6) = {5, 6};  Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};  Plane Surface(2) = {2};
Transfinite Curve {1, 3, 6} = length + 1;
Transfinite Curve {2, 4} = deep + 1;
Transfinite Curve {5, 7} = 2;
Transfinite Surface {1};  Transfinite Surface {2};
Recombine Surface {1, 2};
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Curve("base") = {1};
Physical Curve("sides") = {2, 4, 5, 7};
Physical Curve("top") = {3};
