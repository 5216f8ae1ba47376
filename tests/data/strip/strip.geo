// Soil under a strip with a mesh of its own, on the left of the soil; half of a symmetric problem. The surface of the soil has a corner of
// cells at `node`: where the strip ends, or elsewhere, so that it ends within a cell. The strip lies `gap` above the soil.
DefineConstant[
  width = {2, Name "Parameters/width"}, depth = {1, Name "Parameters/depth"}, air = {0.2, Name "Parameters/air"},
  strip = {1, Name "Parameters/strip"}, node = {1, Name "Parameters/node"}, thick = {0.2, Name "Parameters/thick"},
  gap = {0, Name "Parameters/gap"}, h = {0.1, Name "Parameters/h"}, hs = {0.1, Name "Parameters/hs"}
];
Point(1) = {0, -depth, 0, h}; Point(2) = {width, -depth, 0, h};
Point(3) = {width, 0, 0, h}; Point(4) = {node, 0, 0, h}; Point(5) = {0, 0, 0, h};
Point(6) = {width, air, 0, h}; Point(7) = {0, air, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Line(6) = {3, 6}; Line(7) = {6, 7}; Line(8) = {7, 5};
Curve Loop(1) = {1, 2, 3, 4, 5}; Plane Surface(1) = {1};
Curve Loop(2) = {-4, -3, 6, 7, 8}; Plane Surface(2) = {2};
Point(11) = {0, gap, 0, hs}; Point(12) = {strip, gap, 0, hs};
Point(13) = {strip, gap + thick, 0, hs}; Point(14) = {0, gap + thick, 0, hs};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};
Physical Surface("soil") = {1}; Physical Surface("air") = {2}; Physical Surface("strip") = {3};
Physical Curve("bottom") = {1}; Physical Curve("side") = {2, 5};
Physical Curve("beside") = {3}; Physical Curve("beneath") = {4}; Physical Curve("top") = {13};
