// Two blocks, one on the other, with meshes that have nothing to do with each other.
DefineConstant[
  width = {2, Name "Parameters/width"}, height = {1, Name "Parameters/height"},
  h = {0.25, Name "Parameters/h"}, hu = {0.17, Name "Parameters/hu"}
];
Point(1) = {0, -height, 0, h};
Point(2) = {width, -height, 0, h};
Point(3) = {width, 0, 0, h};
Point(4) = {0, 0, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Point(11) = {0, 0, 0, hu};
Point(12) = {width, 0, 0, hu};
Point(13) = {width, height, 0, hu};
Point(14) = {0, height, 0, hu};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14};
Plane Surface(2) = {2};
Physical Surface("lower") = {1};
Physical Surface("upper") = {2};
Physical Curve("bottom") = {1};
Physical Curve("top") = {13};
Physical Curve("sides") = {2, 4, 12, 14};
Physical Curve("lower_sides") = {2, 4};
Physical Curve("upper_sides") = {12, 14};
