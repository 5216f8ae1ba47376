// A seabed slope that fails and runs out over the plain in front of it.
//
//  A                  B
//  +------------------+ - - - - - - - - - - - - - - - +  y = height + headroom
//  |                                                  |
//  +------------------+            water              |  y = height
//  |    crest          \                              | end
//  | back     soil      \  slope                      |
//  |                     \_________ plain ____________|  y = 0
//  |                                                  |
//  +--------------------------------------------------+  y = -base
//                        bottom
//
// regions  soil, water (a buffer: background cells without points, into which the soil moves)
// curves   bottom, back, end, crest, slope, plain, top
// Sizes: h in the soil of the slope and in the run-out above the plain, growing to h * coarse at the back,
// at the bottom and in the water above the crest; at the toe h * toe.
DefineConstant[
  height   = {5,   Min 1e-6, Name "Parameters/height"},   // of the slope [m]
  angle    = {45, Min 1, Max 90, Name "Parameters/angle"}, // of the slope to the horizontal [degrees]
  base     = {1,   Min 1e-6, Name "Parameters/base"},     // soil below the plain [m]
  crest    = {10,  Min 1e-6, Name "Parameters/crest"},    // length of the crest [m]
  plain    = {15,  Min 1e-6, Name "Parameters/plain"},    // length of the plain, the room for the run-out [m]
  headroom = {1,   Min 1e-6, Name "Parameters/headroom"}, // water above the crest [m]
  h        = {0.5, Min 1e-6, Name "Parameters/h"},        // size of the cells [m]
  coarse   = {1,   Min 1,    Name "Parameters/coarse"},   // growth of the cells away from the slope
  toe      = {1,   Min 1e-6, Name "Parameters/toe"}       // size of the cells at the toe, in h
];
// The toe is at x = 0, the slope rises to the left.
run = angle == 90 ? 0 : height / Tan(angle * Pi / 180);
left = -run - crest;
Point(1) = {left, -base, 0, coarse * h};
Point(2) = {plain, -base, 0, coarse * h};
Point(3) = {plain, 0, 0, h};
Point(4) = {0, 0, 0, toe * h};
Point(5) = {-run, height, 0, h};
Point(6) = {left, height, 0, coarse * h};
Point(7) = {plain, height + headroom, 0, coarse * h};
Point(8) = {left, height + headroom, 0, coarse * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {3, 7};
Line(8) = {7, 8};
Line(9) = {8, 6};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {7, 8, 9, -5, -4, -3};
Plane Surface(2) = {2};
Physical Surface("soil") = {1};
Physical Surface("water") = {2};
Physical Curve("bottom") = {1};
Physical Curve("end") = {2, 7};
Physical Curve("plain") = {3};
Physical Curve("slope") = {4};
Physical Curve("crest") = {5};
Physical Curve("back") = {6, 9};
Physical Curve("top") = {8};
