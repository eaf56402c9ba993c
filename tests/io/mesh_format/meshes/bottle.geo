// A bottle of shells: a profile of body, shoulder and neck turned about z, closed by a floor with triangles at its centre.
//   gmsh bottle.geo -3 -format msh41 -o bottle.msh
r = 32; neck = 12; floor = 8;
Point(1) = {floor, 0, 0}; Point(2) = {r - 6, 0, 0}; Point(3) = {r - 6, 0, 6}; Point(4) = {r, 0, 6};
Point(5) = {r, 0, 110}; Point(6) = {neck, 0, 150}; Point(7) = {neck, 0, 175}; Point(8) = {0, 0, 0};
Point(9) = {r, 0, 132}; Point(10) = {neck, 0, 130};
Line(1) = {1, 2}; Circle(2) = {2, 3, 4}; Line(3) = {4, 5}; Bezier(4) = {5, 9, 10, 6}; Line(5) = {6, 7};
Line(6) = {8, 1};
Transfinite Curve{1} = 4; Transfinite Curve{2} = 3; Transfinite Curve{3} = 16; Transfinite Curve{4} = 8;
Transfinite Curve{5} = 4; Transfinite Curve{6} = 2;
skin[] = {}; mouth[] = {};
For i In {1:6}
  curve = i;
  For quarter In {1:4}
    turned[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 2} { Curve{curve}; Layers{6}; Recombine; };
    curve = turned[0];
    skin[] += turned[1];
    If (i == 5)
      mouth[] += turned[2];
    EndIf
  EndFor
EndFor
Coherence;
Physical Surface("skin") = skin[];
Physical Curve("mouth") = mouth[];
