// A slab above a block with a groove, and air all around the slab.
DefineConstant[
  width = {2, Name "Parameters/width"}, depth = {0.9, Name "Parameters/depth"}, left = {0.6, Name "Parameters/left"},
  right = {1.4, Name "Parameters/right"}, deep = {0.5, Name "Parameters/deep"}, gap = {0.02, Name "Parameters/gap"},
  thick = {0.4, Name "Parameters/thick"}, beside = {0.2, Name "Parameters/beside"}, air = {0.5, Name "Parameters/air"},
  h = {0.1, Name "Parameters/h"}
];
top = gap + thick;
Point(1) = {0, -depth, 0, h}; Point(2) = {width, -depth, 0, h}; Point(3) = {width, 0, 0, h}; Point(4) = {right, 0, 0, h};
Point(5) = {right, -deep, 0, h}; Point(6) = {left, -deep, 0, h}; Point(7) = {left, 0, 0, h}; Point(8) = {0, 0, 0, h};
Point(9) = {beside, gap, 0, h}; Point(10) = {width - beside, gap, 0, h}; Point(11) = {width - beside, top, 0, h};
Point(12) = {beside, top, 0, h}; Point(13) = {width, top + air, 0, h}; Point(14) = {0, top + air, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7};
Line(7) = {7, 8}; Line(8) = {8, 1}; Line(9) = {4, 7}; Line(10) = {9, 10}; Line(11) = {10, 11}; Line(12) = {11, 12};
Line(13) = {12, 9}; Line(14) = {3, 13}; Line(15) = {13, 14}; Line(16) = {14, 8};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8}; Plane Surface(1) = {1};
Curve Loop(2) = {9, -6, -5, -4}; Plane Surface(2) = {2};
Curve Loop(3) = {10, 11, 12, 13}; Plane Surface(3) = {3};
Curve Loop(4) = {14, 15, 16, -7, -9, -3}; Plane Surface(4) = {4, 3};
Physical Surface("block") = {1}; Physical Surface("groove") = {2}; Physical Surface("slab") = {3}; Physical Surface("air") = {4};
Physical Curve("bottom") = {1}; Physical Curve("side") = {2, 8, 14, 16};
