// Mesh of scour-under-cylinder.prm: a channel with a round hole, quadrilaterals, which the program halves where needed; lengths in m.
//   gmsh -2 -format msh41 scour.geo -o scour.msh
W = 0.036; H = 0.014; x0 = 0.012; y0 = 0.0062; r = 0.002; b = 0.0038; // the cylinder, and half the width of the square around it
n = 4; // cells along a quarter of the circle
s = 0.5 * Sqrt(2);
Point(1) = {x0, y0, 0};
Point(2) = {x0 - s * r, y0 - s * r, 0}; Point(3) = {x0 + s * r, y0 - s * r, 0}; Point(4) = {x0 + s * r, y0 + s * r, 0}; Point(5) = {x0 - s * r, y0 + s * r, 0};
Point(6) = {x0 - b, y0 - b, 0}; Point(7) = {x0 + b, y0 - b, 0}; Point(8) = {x0 + b, y0 + b, 0}; Point(9) = {x0 - b, y0 + b, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 9}; Line(8) = {9, 6};
Line(9) = {2, 6}; Line(10) = {3, 7}; Line(11) = {4, 8}; Line(12) = {5, 9};
Curve Loop(1) = {1, 10, -5, -9}; Plane Surface(1) = {1}; Curve Loop(2) = {2, 11, -6, -10}; Plane Surface(2) = {2};
Curve Loop(3) = {3, 12, -7, -11}; Plane Surface(3) = {3}; Curve Loop(4) = {4, 9, -8, -12}; Plane Surface(4) = {4};
// the channel around that square: three columns of three blocks
Point(10) = {0, 0, 0}; Point(11) = {x0 - b, 0, 0}; Point(12) = {x0 + b, 0, 0}; Point(13) = {W, 0, 0};
Point(14) = {0, y0 - b, 0}; Point(15) = {W, y0 - b, 0}; Point(16) = {0, y0 + b, 0}; Point(17) = {W, y0 + b, 0};
Point(18) = {0, H, 0}; Point(19) = {x0 - b, H, 0}; Point(20) = {x0 + b, H, 0}; Point(21) = {W, H, 0};
Line(20) = {10, 11}; Line(21) = {11, 12}; Line(22) = {12, 13}; Line(23) = {14, 6}; Line(24) = {7, 15}; Line(25) = {16, 9}; Line(26) = {8, 17};
Line(27) = {18, 19}; Line(28) = {19, 20}; Line(29) = {20, 21};
Line(30) = {10, 14}; Line(31) = {11, 6}; Line(32) = {12, 7}; Line(33) = {13, 15}; Line(34) = {14, 16}; Line(35) = {15, 17};
Line(36) = {16, 18}; Line(37) = {9, 19}; Line(38) = {8, 20}; Line(39) = {17, 21};
Curve Loop(10) = {20, 31, -23, -30}; Plane Surface(10) = {10}; Curve Loop(11) = {21, 32, -5, -31}; Plane Surface(11) = {11};
Curve Loop(12) = {22, 33, -24, -32}; Plane Surface(12) = {12}; Curve Loop(13) = {23, -8, -25, -34}; Plane Surface(13) = {13};
Curve Loop(14) = {24, 35, -26, -6}; Plane Surface(14) = {14}; Curve Loop(15) = {25, 37, -27, -36}; Plane Surface(15) = {15};
Curve Loop(16) = {-7, 38, -28, -37}; Plane Surface(16) = {16}; Curve Loop(17) = {26, 39, -29, -38}; Plane Surface(17) = {17};
Transfinite Curve {1, 2, 3, 4, 5, 6, 7, 8, 21, 28, 34, 35} = n + 1;
Transfinite Curve {9, 10, 11, 12, 30, 31, 32, 33} = 2;
Transfinite Curve {20, 23, 25, 27} = 5; Transfinite Curve {22, 24, 26, 29} = 12; Transfinite Curve {36, 37, 38, 39} = 3;
Transfinite Surface {1, 2, 3, 4, 10, 11, 12, 13, 14, 15, 16, 17}; Recombine Surface {1, 2, 3, 4, 10, 11, 12, 13, 14, 15, 16, 17};
Physical Curve("bottom") = {20, 21, 22}; Physical Curve("right") = {33, 35, 39}; Physical Curve("top") = {27, 28, 29};
Physical Curve("left") = {30, 34, 36}; Physical Curve("cylinder") = {1, 2, 3, 4};
Physical Surface("channel") = {1, 2, 3, 4, 10, 11, 12, 13, 14, 15, 16, 17};
