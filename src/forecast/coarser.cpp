#include "src/forecast/coarser.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

int fewer(int elements, double factor, int least = 1) {
  return std::min(elements, std::max(least, static_cast<int>(std::lround(elements / factor))));
}
int fewer_even(int elements, double factor) { return 2 * fewer(elements / 2, factor); }

template <std::size_t count>
void reduce(std::array<int, count>& elements, double factor) {
  for (int& number : elements) number = fewer(number, factor);
}

struct Coarsen {
  double factor;

  void operator()(BoxMesh& mesh) const { reduce(mesh.elements, factor); }
  void operator()(PlateMesh& mesh) const { reduce(mesh.elements, factor); }
  void operator()(CylinderMesh& mesh) const {
    mesh.elements = {fewer(mesh.elements[0], factor, 8), fewer(mesh.elements[1], factor)};
  }
  void operator()(TubeMesh& mesh) const {
    mesh.elements = {fewer(mesh.elements[0], factor, 8), fewer(mesh.elements[1], factor),
                     fewer(mesh.elements[2], factor)};
  }
  void operator()(RodMesh& mesh) const {
    mesh.elements = {fewer_even(mesh.elements[0], factor), fewer(mesh.elements[1], factor)};
  }
  void operator()(WedgeMesh& mesh) const {
    const int least_up = std::min(mesh.elements[1], 2);
    mesh.elements = {fewer(mesh.elements[0], factor), fewer(mesh.elements[1], factor, least_up),
                     fewer(mesh.elements[2], factor)};
  }
  void operator()(SphereMesh& mesh) const { mesh.elements = fewer_even(mesh.elements, factor); }
  void operator()(HollowSphereMesh& mesh) const { mesh.elements = fewer(mesh.elements, factor); }
  void operator()(LineMesh& mesh) const { mesh.elements = fewer(mesh.elements, factor); }
  void operator()(MeshFromFile&) const {}  // as it is
  // At least two particles have to stand side by side everywhere: shapes that become too thin stay.
  void operator()(ParticleMesh& mesh) const {
    ParticleMesh coarse = mesh;
    if (coarse.box) coarse.box->spacing *= factor;
    if (coarse.cylinder) coarse.cylinder->spacing *= factor;
    if (coarse.sphere) coarse.sphere->spacing *= factor;
    if (coarse.fault().empty()) mesh = coarse;
  }
};

}  // namespace

Deck coarser(const Deck& deck, double factor) {
  Deck coarse = deck;
  for (Part& part : coarse.parts) std::visit(Coarsen{factor}, part.mesh);
  coarse.time.step.reset();
  return coarse;
}

}  // namespace brio
