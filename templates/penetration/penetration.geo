// A rigid body pushed into clay: half of it, to the right of its axis.
//
//   shape 0       shape 1        shape 2
//   round bar     flat strip     thin wall
//                                 |  |
//    --\                          |  |
//   |   \                         |  |
//   |    |       +------+         |  |       air
//  -+---/--------+------+---------+--+--------------+ 0      regions  clay, air, body
//   |                                               |        curves   axis, side, bottom
//   | axis             clay                         | side
//   |                                               |
//   +-----------------------------------------------+ -way - beneath
//                     bottom
//
// The body begins on the surface. It has a mesh of its own, which lies over the cells of clay and air; `air` are empty cells that
// clay may heave into. In axisymmetry the same sections are a ball, a plate and a pile.
// Gmsh shows all this, and its numbers may be changed there: gmsh penetration.geo
DefineConstant[
  shape     = {0,    Choices{0 = "round bar", 1 = "flat strip", 2 = "thin wall"}, Name "Parameters/shape"},
  diameter  = {1,    Min 1e-6, Name "Parameters/diameter"},  // of the bar, or the width of the strip [m]
  thickness = {0.25, Min 1e-6, Name "Parameters/thickness"}, // of the strip or of the wall [m]
  way       = {4,    Min 1e-6, Name "Parameters/way"},       // how far the body goes below the surface [m]
  beneath   = {2.5,  Min 1e-6, Name "Parameters/beneath"},   // clay beneath the end of the way [m]
  width     = {5,    Min 1e-6, Name "Parameters/width"},     // of the clay from the axis on [m]
  air       = {1,    Min 1e-6, Name "Parameters/air"},       // height of the room above the clay [m]
  edge      = {0.06, Min 1e-6, Name "Parameters/edge"},      // radius of the edges of strip and wall [m]
  h         = {0.125, Min 1e-6, Name "Parameters/h"},        // size of the cells around the way of the body [m]
  coarse    = {5,    Min 1,    Name "Parameters/coarse"}     // largest size, in h
];
b = (shape == 2 ? thickness : diameter) / 2;
depth = way + beneath;
// Edges that a thin strip or wall has room for.
r = edge;
If (r > 0.6 * b)
  r = 0.6 * b;
EndIf
If (r > 0.3 * thickness)
  r = 0.3 * thickness;
EndIf

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
If (shape == 0)
  Point(12) = {b, b, 0};
  Point(13) = {0, 2 * b, 0};
  Point(14) = {0, b, 0};
  Circle(11) = {11, 14, 12};
  Circle(12) = {12, 14, 13};
  Line(13) = {13, 14};
  Line(14) = {14, 11};
  Curve Loop(3) = {11, 12, 13, 14};
Else
  // Strip or wall: the base with its round edge, the side, the top. The wall stands out of the clay to the end.
  height = shape == 1 ? thickness : way + 2 * air;
  Point(12) = {b - r, 0, 0};
  Point(13) = {b - r, r, 0};
  Point(14) = {b, r, 0};
  Line(11) = {11, 12};
  Circle(12) = {12, 13, 14};
  If (shape == 1)
    Point(15) = {b, height - r, 0};
    Point(16) = {b - r, height - r, 0};
    Point(17) = {b - r, height, 0};
    Point(18) = {0, height, 0};
    Line(13) = {14, 15};
    Circle(14) = {15, 16, 17};
    Line(15) = {17, 18};
    Line(16) = {18, 11};
    Curve Loop(3) = {11, 12, 13, 14, 15, 16};
  Else
    Point(15) = {b, height, 0};
    Point(18) = {0, height, 0};
    Line(13) = {14, 15};
    Line(14) = {15, 18};
    Line(15) = {18, 11};
    Curve Loop(3) = {11, 12, 13, 14, 15};
  EndIf
EndIf
Plane Surface(3) = {3};

// Sizes of cells: h in a box around the way of the body, growing outside of it.
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = 2 * b;
Field[1].YMin = -way - b;
Field[1].YMax = way + 2 * air;
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
