// A block at the upper end of a slope, and the grid above that, which it lies on and nothing is in.
//  8---------------7
//  |  3----4       |     regions  body (1 to 4), air (5 to 8)
//  |  |body|       |     curves   slope (5 to 6)
//  |  1----2       |
//  5---------------6     (turned clockwise by the angle of the slope)
DefineConstant[
  angle = {20, Name "Parameters/angle"}, length = {4, Name "Parameters/length"}, width = {1, Name "Parameters/width"},
  height = {0.5, Name "Parameters/height"}, air = {1, Name "Parameters/air"}, h = {0.25, Name "Parameters/h"}
];
c = Cos(angle * Pi / 180);
s = Sin(angle * Pi / 180);
Point(1) = {0, 0, 0, h};
Point(2) = {width * c, -width * s, 0, h};
Point(3) = {height * s, height * c, 0, h};
Point(4) = {width * c + height * s, -width * s + height * c, 0, h};
Point(5) = {-0.5 * c, 0.5 * s, 0, 2 * h};
Point(6) = {length * c, -length * s, 0, 2 * h};
Point(7) = {length * c + air * s, -length * s + air * c, 0, 2 * h};
Point(8) = {-0.5 * c + air * s, 0.5 * s + air * c, 0, 2 * h};
Line(1) = {1, 2};
Line(2) = {2, 4};
Line(3) = {4, 3};
Line(4) = {3, 1};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 5};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(2) = {2};
Physical Surface("body") = {1};
Physical Surface("air") = {2};
Physical Curve("slope") = {5};
