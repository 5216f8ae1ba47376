// A rigid body that falls on clay: half of it, to the right of its axis.
//
//   tip > 0          tip 0
//   +------+         +------+
//   |      |         |      |
//   | body |         | body |        air
//   |     /          |      |
//   |  /             |      |
//  -+--------       -+------+-------------+ 0      regions  clay, air, body
//   |                                     |        curves   axis, side, bottom
//   | axis           clay                 | side
//   |                                     |
//   +-------------------------------------+ -way - beneath
//                  bottom
//
// The body begins on the surface, with the velocity of its fall. It has a mesh of its own, which lies over the cells of clay and air; `air` are empty
// cells that clay may heave into. In axisymmetry it is a cylinder with a cone or a flat base, in plane
// strain a wall with a wedge, or a block.
// Gmsh shows all this, and its numbers may be changed there: gmsh impact.geo
DefineConstant[
  half    = {0.2,  Min 1e-6, Name "Parameters/half"},    // half of the width of the body, or its radius [m]
  height  = {1,    Min 1e-6, Name "Parameters/height"},  // of the body above its tip [m]
  tip     = {0.35, Min 0,    Name "Parameters/tip"},     // height of the wedge or cone below that [m]; 0: the base is flat
  edge    = {0.03, Min 1e-6, Name "Parameters/edge"},    // radius of the edges of a flat base [m]
  way     = {1,    Min 1e-6, Name "Parameters/way"},     // how far the body may go below the surface [m]
  beneath = {0.7,  Min 1e-6, Name "Parameters/beneath"}, // clay beneath the end of the way [m]
  width   = {1.2,  Min 1e-6, Name "Parameters/width"},   // of the clay from the axis on [m]
  air     = {0.2,  Min 1e-6, Name "Parameters/air"},     // height of the room above the clay [m]
  h       = {0.067, Min 1e-6, Name "Parameters/h"},       // size of the cells around the way of the body [m]
  coarse  = {3,    Min 1,    Name "Parameters/coarse"}   // largest size, in h
];
depth = way + beneath;
// An edge that a narrow body has room for.
r = edge < 0.4 * half ? edge : 0.4 * half;

// Clay, and the air above it.
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

// The body.
Point(11) = {0, 0, 0};
Point(15) = {half, tip + height, 0};
Point(16) = {0, tip + height, 0};
If (tip > 0)
  Point(12) = {half, tip, 0};
  Line(11) = {11, 12};
  Line(12) = {12, 15};
  side[] = {11, 12};
Else
  Point(12) = {half - r, 0, 0};
  Point(13) = {half - r, r, 0};
  Point(14) = {half, r, 0};
  Line(11) = {11, 12};
  Circle(12) = {12, 13, 14};
  Line(13) = {14, 15};
  side[] = {11, 12, 13};
EndIf
Line(14) = {15, 16};
Line(15) = {16, 11};
Curve Loop(3) = {side[], 14, 15};
Plane Surface(3) = {3};

// Small cells along the way.
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = 2 * half;
Field[1].YMin = -way - 2 * half;
Field[1].YMax = air;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

// What case.yaml calls them.
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("body") = {3};
Physical Curve("axis") = {4, 7};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};
