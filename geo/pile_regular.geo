// The pile of pile.geo over a regular grid: rectangles of size h around its way that grow towards the far corners, for schemes that want these.
//
//   +..........................+ water        regions  clay_near, clay_far (both of the grid), water, pile
//   |   |      water           |              curves   head, axis, pile_axis, side, bottom
//   +---+----------------------+ 0            points   tip
//   | c |                      |
//   | l |                      |
//   | a |                      |
//   | y |      clay_far        |
//   |_n_|______________________|
//   |   |                      |
//   +---+----------------------+ -far_y
DefineConstant[
  radius = {0.5,   Min 1e-6, Name "Parameters/radius"},   // of the pile, or half its width [m]
  edge   = {0.1,   Min 1e-6, Name "Parameters/edge"},     // radius of the round edge of its base [m]
  length = {2,     Min 1e-6, Name "Parameters/length"},   // of the pile [m]
  depth  = {1.6,   Min 1e-6, Name "Parameters/depth"},    // it will be pushed to: cells are fine down to there [m]
  far_x  = {15,    Min 1e-6, Name "Parameters/far_x"},    // width and depth of the whole [m]
  far_y  = {12.5,  Min 1e-6, Name "Parameters/far_y"},
  water  = {1.5,   Min 1e-6, Name "Parameters/water"},    // height of the water that soil may heave into [m]
  h      = {0.125, Min 1e-6, Name "Parameters/h"},        // size of the cells around the pile [m]
  growth = {1.15,  Min 1.01, Name "Parameters/growth"}    // of the cells beyond, from one to the next
];
// Whole cells of size h in the near field.
nx = Ceil(2.2 * radius / h - 1e-9);
ny = Ceil((depth + 1.6 * radius) / h - 1e-9);
nw = Ceil(water / h - 1e-9);
x[] = {0, nx * h, far_x};
y[] = {-far_y, -ny * h, 0, nw * h};
mx = Ceil(Log(1 + (growth - 1) * (far_x - nx * h) / h) / Log(growth));
my = Ceil(Log(1 + (growth - 1) * (far_y - ny * h) / h) / Log(growth));
For j In {0:3}
  For i In {0:2}
    Point(1 + i + 3 * j) = {x[i], y[j], 0};
  EndFor
EndFor
For j In {0:3}
  Line(100 + 2 * j) = {1 + 3 * j, 2 + 3 * j};
  Line(101 + 2 * j) = {2 + 3 * j, 3 + 3 * j};
  Transfinite Curve{100 + 2 * j} = nx + 1;
  Transfinite Curve{101 + 2 * j} = mx + 1 Using Progression growth;
EndFor
For i In {0:2}
  Line(200 + 3 * i) = {4 + i, 1 + i};
  Line(201 + 3 * i) = {4 + i, 7 + i};
  Line(202 + 3 * i) = {7 + i, 10 + i};
  Transfinite Curve{200 + 3 * i} = my + 1 Using Progression growth;
  Transfinite Curve{201 + 3 * i} = ny + 1;
  Transfinite Curve{202 + 3 * i} = nw + 1;
EndFor
For i In {0:1}
  Curve Loop(300 + i) = {100 + i, -(203 + 3 * i), -(102 + i), 200 + 3 * i};
  Curve Loop(310 + i) = {102 + i, 204 + 3 * i, -(104 + i), -(201 + 3 * i)};
  Curve Loop(320 + i) = {104 + i, 205 + 3 * i, -(106 + i), -(202 + 3 * i)};
  For j In {0:2}
    Plane Surface(300 + 10 * j + i) = {300 + 10 * j + i};
  EndFor
EndFor
Transfinite Surface{:};
Recombine Surface{:};

Point(21) = {0, 0, 0};
Point(22) = {radius - edge, 0, 0};
Point(23) = {radius - edge, edge, 0};
Point(24) = {radius, edge, 0};
Point(25) = {radius, length, 0};
Point(26) = {0, length, 0};
Line(21) = {21, 22};
Circle(22) = {22, 23, 24};
Line(23) = {24, 25};
Line(24) = {25, 26};
Line(25) = {26, 21};
Curve Loop(4) = {21, 22, 23, 24, 25};
Plane Surface(4) = {4};
Mesh.MeshSizeMax = h;

Physical Surface("clay_near") = {310};
Physical Surface("clay_far") = {300, 301, 311};
Physical Surface("water") = {320, 321};
Physical Surface("pile") = {4};
Physical Curve("bottom") = {100, 101};
Physical Curve("side") = {206, 207, 208};
Physical Curve("axis") = {200, 201, 202};
Physical Curve("pile_axis") = {25};
Physical Curve("head") = {24};
Physical Point("tip") = {21};
