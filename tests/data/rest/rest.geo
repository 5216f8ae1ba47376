// A block 1 m x 1 m on a wall with room beside and above it; a lattice of right triangles, their diagonals all alike or (alternate = 1) in turn.
DefineConstant[ alternate = {0, Name "Parameters/alternate"} ];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0};
Point(4) = {2, 1, 0}; Point(5) = {1, 1, 0}; Point(6) = {0, 1, 0};
Point(7) = {0, 1.5, 0}; Point(8) = {1, 1.5, 0}; Point(9) = {2, 1.5, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Line(7) = {2, 5}; Line(8) = {6, 7}; Line(9) = {7, 8}; Line(10) = {8, 5}; Line(11) = {8, 9}; Line(12) = {9, 4};
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};
Curve Loop(3) = {-5, -10, -9, -8}; Plane Surface(3) = {3};
Curve Loop(4) = {-4, -12, -11, 10}; Plane Surface(4) = {4};
Transfinite Curve {1, 2, 3, 4, 5, 6, 7, 9, 11} = 5;
Transfinite Curve {8, 10, 12} = 3;
If (alternate)
  Transfinite Surface {1, 2, 3, 4} Alternate;
Else
  Transfinite Surface {1, 2, 3, 4};
EndIf
Physical Surface("body") = {1}; Physical Surface("room") = {2, 3, 4};
Physical Curve("lower") = {1, 2}; Physical Curve("left") = {6, 8}; Physical Curve("right") = {3, 12};
