// A bank whose toe is on its base, in front of it room to slide into.
//
//  +--------------------------------------+  y = height + headroom
//  |                                      |
//  +------------------+       room        |  y = height
//  |    crest          \                  | end
//  | back     soil      \ slope           |
//  +---------------------+----------------+  y = 0
//           bottom             floor
//
// regions  soil, room (a buffer: cells without points, into which the soil moves)
// curves   bottom, floor, back, end, crest, slope, top
// Sizes: h at the slope and in the room in front of it, growing to h * coarse at the back and above the crest.
DefineConstant[
  height   = {10,  Min 1e-6, Name "Parameters/height"},   // of the bank [m]
  angle    = {45,  Min 1, Max 90, Name "Parameters/angle"}, // of the slope to the horizontal [degrees]
  crest    = {10,  Min 1e-6, Name "Parameters/crest"},    // length of the crest [m]
  floor    = {10,  Min 1e-6, Name "Parameters/floor"},    // length of the base in front of the toe [m]
  headroom = {1,   Min 1e-6, Name "Parameters/headroom"}, // room above the crest [m]
  h        = {1,   Min 1e-6, Name "Parameters/h"},        // size of the cells [m]
  coarse   = {1,   Min 1,    Name "Parameters/coarse"}    // growth of the cells away from the slope
];
// The toe is at x = 0, the slope rises to the left.
run = angle == 90 ? 0 : height / Tan(angle * Pi / 180);
left = -run - crest;
Point(1) = {left, 0, 0, coarse * h};
Point(2) = {0, 0, 0, h};
Point(3) = {floor, 0, 0, h};
Point(4) = {-run, height, 0, h};
Point(5) = {left, height, 0, coarse * h};
Point(6) = {floor, height + headroom, 0, coarse * h};
Point(7) = {left, height + headroom, 0, coarse * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {2, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Line(6) = {3, 6};
Line(7) = {6, 7};
Line(8) = {7, 5};
Curve Loop(1) = {1, 3, 4, 5};
Plane Surface(1) = {1};
Curve Loop(2) = {2, 6, 7, 8, -4, -3};
Plane Surface(2) = {2};
Physical Surface("soil") = {1};
Physical Surface("room") = {2};
Physical Curve("bottom") = {1};
Physical Curve("floor") = {2};
Physical Curve("slope") = {3};
Physical Curve("crest") = {4};
Physical Curve("back") = {5, 8};
Physical Curve("end") = {6};
Physical Curve("top") = {7};
