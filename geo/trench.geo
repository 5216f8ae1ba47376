// Half of a trench in clay with a pipe on its floor, symmetric about x = 0.
//
//              water
//  |          _____________ 0          regions  clay, water, pipe
//  |         /    crest    |           curves   axis, side, bottom, floor, wall, crest
//  |)       / wall         | side
//  |)_____ / toe           |
//  | floor        clay     | -depth
//  +-----------------------+ -depth - beneath
//            bottom
//
// Cells are of size h between the trench and a depth behind its wall, h * toe at the toe, and grow to h * coarse at the side and the bottom.
DefineConstant[
  depth    = {2,    Min 1e-6, Name "Parameters/depth"},    // of the trench [m]
  floor    = {1,    Min 1e-6, Name "Parameters/floor"},    // half of the width of its floor [m]
  angle    = {90,   Min 10, Max 90, Name "Parameters/angle"}, // of its walls to the horizontal [degrees]
  diameter = {0.6,  Min 1e-6, Name "Parameters/diameter"}, // of the pipe [m]
  beneath  = {0.75,    Min 1e-6, Name "Parameters/beneath"},  // clay below the floor [m]
  aside    = {6,    Min 1e-6, Name "Parameters/aside"},    // clay behind the crest [m]
  water    = {0.5,  Min 1e-6, Name "Parameters/water"},    // height that clay may heave into [m]
  h        = {0.15, Min 1e-6, Name "Parameters/h"},        // size of the cells [m]
  toe      = {1,    Min 1e-6, Name "Parameters/toe"},      // size at the toe, in h
  coarse   = {3,    Min 1, Name "Parameters/coarse"}       // largest size, in h
];
run = angle == 90 ? 0 : depth / Tan(angle * Pi / 180);
far = floor + run + aside;
Point(1) = {0, -depth - beneath, 0, coarse * h};
Point(2) = {far, -depth - beneath, 0, coarse * h};
Point(3) = {far, 0, 0, coarse * h};
Point(4) = {floor + run + depth, 0, 0, h};
Point(5) = {floor + run, 0, 0, h};
Point(6) = {floor, -depth, 0, toe * h};
Point(7) = {0, -depth, 0, h};
Point(8) = {0, water, 0, h};
Point(9) = {far, water, 0, coarse * h};
Point(10) = {0, -depth - 0.5 * beneath, 0, 2 * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 10};
Line(8) = {10, 1};
Line(9) = {7, 8};
Line(10) = {8, 9};
Line(11) = {9, 3};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8};
Plane Surface(1) = {1};
Curve Loop(2) = {9, 10, 11, 3, 4, 5, 6};
Plane Surface(2) = {2};

radius = diameter / 2;
Point(21) = {0, -depth, 0, h};
Point(22) = {radius, -depth + radius, 0, h};
Point(23) = {0, -depth + 2 * radius, 0, h};
Point(24) = {0, -depth + radius, 0, h};
Circle(21) = {21, 24, 22};
Circle(22) = {22, 24, 23};
Line(23) = {23, 24};
Line(24) = {24, 21};
Curve Loop(3) = {21, 22, 23, 24};
Plane Surface(3) = {3};
Physical Surface("clay") = {1};
Physical Surface("water") = {2};
Physical Surface("pipe") = {3};
Physical Curve("axis") = {7, 8, 9};
Physical Curve("side") = {2, 11};
Physical Curve("bottom") = {1};
Physical Curve("floor") = {6};
Physical Curve("wall") = {5};
Physical Curve("crest") = {3, 4};
