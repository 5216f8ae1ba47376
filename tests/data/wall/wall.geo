// A block of soil at the upper end of a slope that is a rigid wall, and air around it.
//   6---------------5      regions  soil, air
//   |   air         |      curves   slope, side (of the soil), lid
//   3----4          |
//   |soil|          |      (turned clockwise by the angle of the slope)
//   1----2----------7
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
Point(5) = {length * c + air * s, -length * s + air * c, 0, h};
Point(6) = {air * s, air * c, 0, h};
Point(7) = {length * c, -length * s, 0, h};
Line(1) = {1, 2};
Line(2) = {7, 2};
Line(3) = {2, 4};
Line(4) = {4, 3};
Line(5) = {3, 1};
Line(6) = {7, 5};
Line(7) = {5, 6};
Line(8) = {6, 3};
Curve Loop(1) = {1, 3, 4, 5};
Plane Surface(1) = {1};
Curve Loop(2) = {-2, 6, 7, 8, -4, -3};
Plane Surface(2) = {2};
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Curve("slope") = {1, 2};
Physical Curve("side") = {3};
Physical Curve("lid") = {6, 7, 8};
