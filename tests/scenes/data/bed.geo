// Mesh of bed.prm in triangles: h/d = 1 in bands at the faces of the bed, 4 elsewhere.
//   gmsh -2 -format msh41 bed.geo -o bed.msh
W = 0.004; H = 0.006; L = 0.0025; d = 2.2e-4; band = 2 * d; growth = 0.5;
Point(1) = {0, 0, 0}; Point(2) = {W, 0, 0}; Point(3) = {W, H, 0}; Point(4) = {0, H, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Surface("domain") = {1};
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, Max(%g, %g + %g * Min(y - %g, Abs(y - %g) - %g)))", 4 * d, d, d, growth, band, L, band);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0;
Mesh.RandomSeed = 1;
