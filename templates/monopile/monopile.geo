// An open steel pile on clay: half a section from its axis of symmetry on.
//
//   |        | |
//   |    pile| |
//   |  air   | |                regions  clay, air, pile
//   +--------+-+-------+ 0      curves   axis, side, bottom
//   |                  |
//   |  clay            | side
//   +------------------+ -way - beneath
//         bottom
//
// Cells are of size h along the way of the pile and grow with the distance from it, to h * coarse at most.
// Gmsh shows all this, and its numbers may be changed there: gmsh monopile.geo
DefineConstant[
  radius    = {2.5, Min 1e-6, Name "Parameters/radius"},    // to the outside of the pile [m]
  thickness = {0.2, Min 1e-6, Name "Parameters/thickness"}, // of its wall [m]
  length    = {5,   Min 1e-6, Name "Parameters/length"},    // of the pile [m]
  way       = {3,   Min 1e-6, Name "Parameters/way"},       // that its tip will go below the surface [m]
  beneath   = {5,   Min 1e-6, Name "Parameters/beneath"},   // clay beneath the end of the way [m]
  width     = {12,  Min 1e-6, Name "Parameters/width"},     // of the clay from the axis on [m]
  air       = {1,   Min 1e-6, Name "Parameters/air"},       // height that clay may heave into [m]
  edge      = {0.05, Min 1e-6, Name "Parameters/edge"},     // radius of the edges of the tip [m]
  h         = {0.1, Min 1e-6, Name "Parameters/h"},         // size of the cells at the pile [m]
  coarse    = {12,  Min 1,    Name "Parameters/coarse"}     // largest size, in h
];
depth = way + beneath;
inner = radius - thickness;
Point(1) = {0, -depth, 0};
Point(2) = {width, -depth, 0};
Point(3) = {width, 0, 0};
Point(4) = {0, 0, 0};
Point(5) = {width, air, 0};
Point(6) = {0, air, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};
Point(11) = {inner + edge, 0, 0};
Point(12) = {radius - edge, 0, 0};
Point(13) = {radius, length, 0};
Point(14) = {inner, length, 0};
Point(15) = {inner, edge, 0};
Point(16) = {inner + edge, edge, 0};
Point(17) = {radius, edge, 0};
Point(18) = {radius - edge, edge, 0};
Line(11) = {11, 12};
Circle(12) = {12, 18, 17};
Line(13) = {17, 13};
Line(14) = {13, 14};
Line(15) = {14, 15};
Circle(16) = {15, 16, 11};
Curve Loop(3) = {11, 12, 13, 14, 15, 16};
Plane Surface(3) = {3};
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = inner - 2 * h;
Field[1].XMax = radius + 2 * h;
Field[1].YMin = -way - 4 * h;
Field[1].YMax = length;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("pile") = {3};
Physical Curve("axis") = {4, 7};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};
Physical Curve("outside") = {13};
Physical Curve("inside") = {15};
Physical Curve("tip") = {11, 12, 16};
