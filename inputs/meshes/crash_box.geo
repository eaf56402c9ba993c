// A crash box of shells: a square tube of 70 x 70 x 160 mm with round edges; a hole in each of two opposite walls is where it folds
// first. Lengths in mm.
//   gmsh crash_box.geo -2 -format msh41 -o crash_box.msh
a = 35; r = 8; h = 160;  // half width and radius of the middle surface, height
size = 5;                // of elements
hole = 10; at = 125;     // radius and height of the holes
Mesh.RecombineAll = 1;
Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
up = 32; across = 12; corner = 2;  // elements

x[] = {a - r, a, a, a - r, -a + r, -a, -a, -a + r};
y[] = {-a, -a + r, a - r, a, a, a - r, -a + r, -a};
For i In {0:7}
  Point(1 + i) = {x[i], y[i], 0};
  Point(11 + i) = {x[i], y[i], h};
  Line(100 + i) = {1 + i, 11 + i};
  Transfinite Curve{100 + i} = up + 1;
EndFor
For level In {0:1}
  centre = newp;
  Point(centre + 0) = {a - r, -a + r, level * h};
  Point(centre + 1) = {a - r, a - r, level * h};
  Point(centre + 2) = {-a + r, a - r, level * h};
  Point(centre + 3) = {-a + r, -a + r, level * h};
  first = 1 + 10 * level;
  ring = 200 + 100 * level;
  For k In {0:3}
    Circle(ring + 2 * k) = {first + 2 * k, centre + k, first + 2 * k + 1};
    Line(ring + 2 * k + 1) = {first + 2 * k + 1, first + (2 * k + 2) % 8};
    Transfinite Curve{ring + 2 * k} = corner + 1;
    Transfinite Curve{ring + 2 * k + 1} = across + 1;
  EndFor
EndFor
For i In {0:7}
  Curve Loop(400 + i) = {200 + i, 100 + (i + 1) % 8, -(300 + i), -(100 + i)};
EndFor
For i In {0:7}
  If (i % 4 != 1)
    Surface(500 + i) = {400 + i};
    Transfinite Surface{500 + i};
  EndIf
EndFor
// The walls at x = a and x = -a have the holes.
For k In {0:1}
  s = 1 - 2 * k;
  p = newp;
  Point(p) = {s * a, 0, at};
  Point(p + 1) = {s * a, hole, at};
  Point(p + 2) = {s * a, 0, at + hole};
  Point(p + 3) = {s * a, -hole, at};
  Point(p + 4) = {s * a, 0, at - hole};
  c = 600 + 10 * k;
  For q In {0:3}
    Circle(c + q) = {p + 1 + q, p, p + 1 + (q + 1) % 4};
    Transfinite Curve{c + q} = 4;
  EndFor
  Curve Loop(700 + k) = {c, c + 1, c + 2, c + 3};
  Plane Surface(501 + 4 * k) = {401 + 4 * k, 700 + k};
EndFor
Physical Surface("wall") = {500:507};
Physical Curve("foot") = {200:207};
Physical Curve("head") = {300:307};
Physical Curve("holes") = {600:603, 610:613};
