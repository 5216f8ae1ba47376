// Half of a rigid strip footing on soil, beside its plane of symmetry.
//
//        air        |               regions  soil, footing, air (a buffer)
//  +===+            | side          curves   axis, side, bottom
//  +===+------------+ 0
// a|                |
// x|      soil      |
// i|                |
// s+----------------+ -depth
//        bottom   width
//
// The footing has a mesh of its own, which lies over the cells of the air above the soil. Cells are of size h at the edge of the footing, twice that in
// its middle, and grow with the distance from it, to h * coarse at the far corners. Lengths are in half widths of the footing.
DefineConstant[
  half_width = {1,    Min 1e-6, Name "Parameters/half_width"}, // of the footing [m]
  width      = {10,   Min 1e-6, Name "Parameters/width"},      // of the soil, from the axis on
  depth      = {6,    Min 1e-6, Name "Parameters/depth"},      // of the soil
  air        = {0.5,  Min 1e-6, Name "Parameters/air"},        // room that soil may heave into
  thickness  = {0.4,  Min 1e-6, Name "Parameters/thickness"},  // of the footing
  h          = {0.1,  Min 1e-6, Name "Parameters/h"},          // size of the cells at its edge [m]
  coarse     = {8,    Min 1,    Name "Parameters/coarse"}      // largest size, in h
];
b = half_width;
Point(1) = {0, -depth * b, 0, coarse * h};
Point(2) = {width * b, -depth * b, 0, coarse * h};
Point(3) = {width * b, 0, 0, coarse * h};
Point(4) = {1.4 * b, 0, 0, 1.5 * h};
Point(5) = {b, 0, 0, h};
Point(6) = {0, 0, 0, 2 * h};
Point(7) = {width * b, air * b, 0, coarse * h};
Point(8) = {1.4 * b, air * b, 0, 3 * h};
Point(9) = {0, air * b, 0, 3 * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {3, 7};
Line(8) = {7, 8};
Line(9) = {8, 9};
Line(10) = {9, 6};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {7, 8, 9, 10, -5, -4, -3};
Plane Surface(2) = {2};
Point(11) = {0, 0, 0, 2 * h};
Point(12) = {b, 0, 0, 2 * h};
Point(13) = {b, thickness * b, 0, 2 * h};
Point(14) = {0, thickness * b, 0, 2 * h};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Surface("footing") = {3};
Physical Curve("axis") = {6, 10};
Physical Curve("side") = {2, 7};
Physical Curve("bottom") = {1};
