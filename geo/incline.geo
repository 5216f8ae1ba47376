// A block on an incline; the block has a mesh of its own, which is not aligned with that of the grid.
//
//            ____                 regions  ground, air, block
//           /block/---___         curves   foot (bottom and sides of the ground), lid (of the air)
//    -------/____/       |        points   centre (a corner of the block)
//   |  ---___            |
//   | ground  ---___     |
//   +---------------+----+
DefineConstant[
  angle  = {20,   Min 0, Max 45, Name "Parameters/angle"},  // of the slope [degrees]
  length = {6,    Min 1e-6, Name "Parameters/length"},      // of the slope [m]
  depth  = {1,    Min 1e-6, Name "Parameters/depth"},       // of the ground, vertically [m]
  air    = {1.2,  Min 1e-6, Name "Parameters/air"},         // above the ground, vertically [m]
  width  = {1,    Min 1e-6, Name "Parameters/width"},       // of the block along the slope [m]
  height = {0.5,  Min 1e-6, Name "Parameters/height"},      // across it [m]
  start  = {1,    Min 1e-6, Name "Parameters/start"},       // of the block from the upper end of the slope [m]
  h      = {0.25, Min 1e-6, Name "Parameters/h"}            // size of the cells [m]
];
c = Cos(angle * Pi / 180);
s = Sin(angle * Pi / 180);
Point(1) = {0, 0, 0, h};
Point(2) = {length * c, -length * s, 0, h};
Point(3) = {length * c, -length * s - depth, 0, 2 * h};
Point(4) = {0, -depth, 0, 2 * h};
Point(5) = {length * c, -length * s + air, 0, h};
Point(6) = {0, air, 0, h};
Line(1) = {1, 4};
Line(2) = {4, 3};
Line(3) = {3, 2};
Line(4) = {2, 1};
Line(5) = {2, 5};
Line(6) = {5, 6};
Line(7) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {-4, 5, 6, 7};
Plane Surface(2) = {2};
Point(11) = {start * c, -start * s, 0, 0.7 * h};
Point(12) = {(start + width) * c, -(start + width) * s, 0, 0.7 * h};
Point(13) = {(start + width) * c + height * s, -(start + width) * s + height * c, 0, 0.7 * h};
Point(14) = {start * c + height * s, -start * s + height * c, 0, 0.7 * h};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};
Physical Surface("ground") = {1};
Physical Surface("air") = {2};
Physical Surface("block") = {3};
Physical Curve("foot") = {1, 2, 3};
Physical Curve("lid") = {5, 6, 7};
Physical Curve("top") = {13};
