// A slice of a soil with a cylindrical cavity, one cell high: axisymmetric about x = 0.
//
//   +--------+--------------+----- - -+-----------+  y = thickness
//   | hollow | near         | far     | outside   |        regions  hollow, outside (buffers), near, far
//   +--------+--------------+----- - -+-----------+  y = 0  curves  lower, upper, axis, outer (x = outer)
//   0        radius         reach     outer       outer + room
//
// Cells of size h from the axis to `reach`, then growing towards the outside. room = 0 leaves out what is beyond
// `outer`, and the hollow with it, for a grid that is never restored.
DefineConstant[
  radius = {1,    Min 1e-6, Name "Parameters/radius"}, // of the cavity [m]
  reach  = {6,    Min 1e-6, Name "Parameters/reach"},  // end of the fine cells [m]
  outer  = {60,   Min 1e-6, Name "Parameters/outer"},  // radius of the soil [m]
  room   = {2,    Min 0,    Name "Parameters/room"},   // beyond it [m]
  h      = {0.25, Min 1e-6, Name "Parameters/h"}       // size of the cells, and thickness of the slice [m]
];
Point(2) = {radius, 0, 0};
Point(3) = {reach, 0, 0};
Point(4) = {outer, 0, 0};
Point(7) = {radius, h, 0};
Point(8) = {reach, h, 0};
Point(9) = {outer, h, 0};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(7) = {7, 8};
Line(8) = {8, 9};
Line(12) = {2, 7};
Line(13) = {3, 8};
Line(14) = {4, 9};
nn = Ceil((reach - radius) / h - 1e-9);
// Sizes grow by about a tenth from cell to cell.
nf = Ceil(Log(1 + 0.1 * (outer - reach) / h) / Log(1.1));
Transfinite Curve{12, 13, 14} = 2;
Transfinite Curve{2, 7} = nn + 1;
Transfinite Curve{3, 8} = nf + 1 Using Progression 1.1;
Curve Loop(2) = {2, 13, -7, -12};
Plane Surface(2) = {2};
Curve Loop(3) = {3, 14, -8, -13};
Plane Surface(3) = {3};
Transfinite Surface{2} Alternate;
Transfinite Surface{3} Alternate;
Physical Surface("near") = {2};
Physical Surface("far") = {3};
Physical Curve("outer") = {14};
If (room > 0)
  Point(1) = {0, 0, 0};
  Point(5) = {outer + room, 0, 0};
  Point(6) = {0, h, 0};
  Point(10) = {outer + room, h, 0};
  Line(1) = {1, 2};
  Line(4) = {4, 5};
  Line(6) = {6, 7};
  Line(9) = {9, 10};
  Line(11) = {1, 6};
  Line(15) = {5, 10};
  Transfinite Curve{11, 15} = 2;
  Transfinite Curve{1, 6} = Ceil(radius / h - 1e-9) + 1;
  Transfinite Curve{4, 9} = Ceil(2 * room) + 1;
  Curve Loop(1) = {1, 12, -6, -11};
  Plane Surface(1) = {1};
  Curve Loop(4) = {4, 15, -9, -14};
  Plane Surface(4) = {4};
  Transfinite Surface{1} Alternate;
  Transfinite Surface{4} Alternate;
  Physical Surface("hollow") = {1};
  Physical Surface("outside") = {4};
  Physical Curve("axis") = {11};
  Physical Curve("lower") = {1, 2, 3, 4};
  Physical Curve("upper") = {6, 7, 8, 9};
Else
  Physical Curve("lower") = {2, 3};
  Physical Curve("upper") = {7, 8};
EndIf
