// Level ground of two layers, the interface of which dips.
DefineConstant[ dip = {0.2, Name "Parameters/dip"}, h = {2, Min 0.1, Name "Parameters/h"} ];
Point(1) = {0, -10, 0, h};  Point(2) = {20, -10, 0, h};  Point(3) = {20, -5 - 10 * dip, 0, h};
Point(4) = {20, 0, 0, h};  Point(5) = {0, 0, 0, h};  Point(6) = {0, -5 + 10 * dip, 0, h};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 6};  Line(6) = {6, 1};  Line(7) = {3, 6};
Curve Loop(1) = {1, 2, 7, 6};  Plane Surface(1) = {1};
Curve Loop(2) = {3, 4, 5, -7};  Plane Surface(2) = {2};
Point(7) = {20, 1, 0, h};  Point(8) = {0, 1, 0, h};
Line(8) = {4, 7};  Line(9) = {7, 8};  Line(10) = {8, 5};
Curve Loop(3) = {8, 9, 10, -4};  Plane Surface(3) = {3};
Physical Surface("sand") = {1};
Physical Surface("peat") = {2};
Physical Surface("air") = {3};
Physical Curve("bottom") = {1};
Physical Curve("sides") = {2, 3, 5, 6, 8, 10};
Physical Curve("top") = {4};
