// Mesh of hourglass-under-water.prm: two chambers, inclined walls and a neck between them, lengths in m.
//   gmsh -2 -format msh41 hourglass.geo -o hourglass.msh
W = 0.008; neck = 0.0016; h = 0.001; // half widths, and the size of triangles
y1 = 0.008; y2 = 0.0144; y3 = 0.0208; H = 0.0312; // the lower funnel begins, the neck, the upper funnel ends, the top
Point(1) = {-W, 0, 0, h}; Point(2) = {W, 0, 0, h}; Point(3) = {W, y1, 0, h}; Point(4) = {neck, y2, 0, h / 2};
Point(5) = {W, y3, 0, h}; Point(6) = {W, H, 0, h}; Point(7) = {-W, H, 0, h}; Point(8) = {-W, y3, 0, h};
Point(9) = {-neck, y2, 0, h / 2}; Point(10) = {-W, y1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8};
Line(8) = {8, 9}; Line(9) = {9, 10}; Line(10) = {10, 1};
Curve Loop(1) = {1 ... 10}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("glass") = {2, 3, 4, 5, 7, 8, 9, 10}; Physical Curve("top") = {6};
Physical Surface("water") = {1};
Mesh.RandomSeed = 1;
