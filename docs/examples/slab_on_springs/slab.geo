// A slab, 4 m long and 0.5 m thick.
DefineConstant[ h = {0.25, Name "Parameters/h"} ];
Point(1) = {0, 0, 0, h}; Point(2) = {4, 0, 0, h}; Point(3) = {4, 0.5, 0, h}; Point(4) = {0, 0.5, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve {1, 3} = Round(4/h) + 1;  Transfinite Curve {2, 4} = Round(0.5/h) + 1;
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("slab") = {1};  Physical Curve("underside") = {1};  Physical Curve("top") = {3};
