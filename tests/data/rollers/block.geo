// A block on an incline, with room above it and at its upper end, or its mirror image.
DefineConstant[ angle = {20, Name "Parameters/angle"}, mirrored = {0, Name "Parameters/mirrored"}, h = {0.25, Min 0.01, Name "Parameters/h"} ];
c = Cos(angle * Pi / 180);  s = Sin(angle * Pi / 180);
L = 3;  H = 1;  R = 0.5;
Macro At
  Point(p) = {(mirrored ? -1 : 1) * (a * c - b * s), a * s + b * c, 0, h};
Return
p = 1; a = 0; b = 0; Call At;
p = 2; a = L; b = 0; Call At;
p = 3; a = L; b = H; Call At;
p = 4; a = 0; b = H; Call At;
p = 5; a = L + R; b = 0; Call At;
p = 6; a = L + R; b = H + R; Call At;
p = 7; a = 0; b = H + R; Call At;
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Line(5) = {2, 5};  Line(6) = {5, 6};  Line(7) = {6, 7};  Line(8) = {7, 4};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Curve Loop(2) = {-2, 5, 6, 7, 8, -3};  Plane Surface(2) = {2};
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Curve("base") = {1, 5};
Physical Curve("end") = {4, 8};
