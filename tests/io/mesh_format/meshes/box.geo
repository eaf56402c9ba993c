// A box of 2 x 1 x 3, as the generator draws it: centred on the origin, 4 x 2 x 6 hexahedra.
//   gmsh box.geo -3 -format msh41 -o box.msh
Point(1) = {-1, -0.5, -1.5};
line[] = Extrude {2, 0, 0} { Point{1}; Layers{4}; Recombine; };
face[] = Extrude {0, 1, 0} { Curve{line[1]}; Layers{2}; Recombine; };
body[] = Extrude {0, 0, 3} { Surface{face[1]}; Layers{6}; Recombine; };
Physical Volume("box") = {body[1]};
Physical Surface("bottom") = {face[1]};
Physical Surface("top") = {body[0]};
