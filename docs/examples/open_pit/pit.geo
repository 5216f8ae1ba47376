// Ground 8 m wide and 4 m deep; left of x = 3 m the upper 2 m are dug in two lifts.
DefineConstant[ h = {0.25, Min 0.05, Name "Parameters/h"} ];
Point(1) = {0, -4, 0, 2*h};  Point(2) = {8, -4, 0, 2*h};  Point(3) = {8, 0, 0, 2*h};  Point(4) = {8, 0.75, 0, 2*h};  Point(5) = {0, 0.75, 0, h};
Point(10) = {0, 0, 0, h};  Point(11) = {0, -1, 0, h};  Point(12) = {0, -2, 0, h};
Point(20) = {3, 0, 0, h};  Point(21) = {3, -1, 0, h};  Point(22) = {3, -2, 0, h};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 10};  Line(6) = {12, 1};  Line(7) = {3, 20};
Line(30) = {10, 20};  Line(31) = {11, 21};  Line(32) = {12, 22};
Line(40) = {10, 11};  Line(41) = {11, 12};  Line(50) = {20, 21};  Line(51) = {21, 22};
Curve Loop(1) = {1, 2, 7, 50, 51, -32, 6};  Plane Surface(1) = {1};
Curve Loop(2) = {3, 4, 5, 30, -7};  Plane Surface(2) = {2};
Curve Loop(3) = {30, 50, -31, -40};  Plane Surface(3) = {3};
Curve Loop(4) = {31, 51, -32, -41};  Plane Surface(4) = {4};
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Surface("lift1") = {3};
Physical Surface("lift2") = {4};
Physical Curve("bottom") = {1};
Physical Curve("sides") = {2, 3, 5, 6, 40, 41};
Physical Curve("floor") = {32};
