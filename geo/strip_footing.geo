// Half of a footing on soil, symmetric about x = 0. In axisymmetry the same section is a circular footing.
//
//   footing   surface
//   +=====+------------------+
// a |                        | s      regions  soil
// x |          soil          | i      curves   footing, surface, axis, side, bottom
// i |                        | d      points   footing_centre, footing_edge
// s +------------------------+ e
//            bottom
//
// Cells grow from h at the edge of the footing, where the stress is singular, to h * coarse far from it. Regular quadrilaterals (quads)
// are of size h everywhere; half_width, width and depth are then to be whole numbers of them.
DefineConstant[
  half_width = {1,    Min 1e-6, Name "Parameters/half_width"}, // B/2 or the radius [m]
  width      = {5,    Min 1e-6, Name "Parameters/width"},      // of the section, in half_width
  depth      = {5,    Min 1e-6, Name "Parameters/depth"},      // of the section, in half_width
  h          = {0.05, Min 1e-6, Name "Parameters/h"},          // size of the cells at the edge [m]
  under      = {2,    Min 1,    Name "Parameters/under"},      // size at the centre of the footing, in h
  coarse     = {12,   Min 1,    Name "Parameters/coarse"},     // size at the far corners, in h
  quads      = {0, Choices{0, 1}, Name "Parameters/quads"}     // 1: regular quadrilaterals
];
b = half_width;
Point(1) = {0, -depth * b, 0, coarse * h};
Point(2) = {width * b, -depth * b, 0, coarse * h};
Point(3) = {width * b, 0, 0, coarse * h};
Point(4) = {b, 0, 0, h};
Point(5) = {0, 0, 0, under * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
If (quads)
  Line(5) = {5, 1};
  Curve Loop(1) = {1, 2, 3, 4, 5};
  Plane Surface(1) = {1};
  across = Round(width * b / h);
  down = Round(depth * b / h);
  beneath = Round(b / h);
  Transfinite Curve{1} = across + 1;
  Transfinite Curve{2, 5} = down + 1;
  Transfinite Curve{3} = across - beneath + 1;
  Transfinite Curve{4} = beneath + 1;
  Transfinite Surface{1} = {1, 2, 3, 5};
  Recombine Surface{1};
  Physical Curve("axis") = {5};
Else
  // Two points at the rim of the mechanism keep the cells fine enough there to carry its slip surfaces.
  Point(6) = {0, -1.2 * b, 0, 2 * under * h};
  Point(7) = {1.9 * b, -0.9 * b, 0, 2 * under * h};
  Line(5) = {5, 6};
  Line(6) = {6, 1};
  Curve Loop(1) = {1, 2, 3, 4, 5, 6};
  Plane Surface(1) = {1};
  Point{7} In Surface{1};
  Physical Curve("axis") = {5, 6};
EndIf
Physical Surface("soil") = {1};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2};
Physical Curve("surface") = {3};
Physical Curve("footing") = {4};
Physical Point("footing_edge") = {4};
Physical Point("footing_centre") = {5};
