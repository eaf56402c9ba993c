#pragma once
/// Linear statics of shells by their tangent stiffness: what the strains of the kernel are worth in the
/// classic problems, without the dynamics.

#include "src/base/index.hpp"
#include "tests/elements/shell/single_shell.hpp"

#include <gtest/gtest.h>

#include <Eigen/Sparse>
#include <functional>

namespace brio {

struct ShellMesh {
  std::vector<Eigen::Vector3d> point;
  std::vector<std::array<int, 4>> element;
};

/// Quadrilaterals over [0, 1] x [0, 1], mapped; numbered along the first direction.
inline ShellMesh mapped_grid(int first, int second,
                             const std::function<Eigen::Vector3d(double, double)>& map) {
  ShellMesh mesh;
  for (int j = 0; j <= second; ++j)
    for (int i = 0; i <= first; ++i) mesh.point.push_back(map(double(i) / first, double(j) / second));
  for (int j = 0; j < second; ++j)
    for (int i = 0; i < first; ++i) {
      const int corner = j * (first + 1) + i;
      mesh.element.push_back({corner, corner + 1, corner + first + 2, corner + first + 1});
    }
  return mesh;
}

class ShellStatics {
 public:
  ShellStatics(const ShellMesh& mesh, const Shell4& shell, const Elastic& law)
      : load_(Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(mesh.point.size()))),
        fixed_(index(load_.size()), false) {
    for (const auto& nodes : mesh.element) {
      Points4 x;
      for (std::size_t n = 0; n < 4; ++n) x[n] = mesh.point[index(nodes[n])];
      const Eigen::Matrix<double, 24, 24> k = stiffness_of(shell, law, x);
      const double bending = k.diagonal().tail<12>().mean();
      const auto place = [&](int c) { return 6 * nodes[index(c) % 12 / 3] + c % 3 + (c < 12 ? 0 : 3); };
      for (int a = 0; a < 24; ++a) {
        for (int b = 0; b < 24; ++b) entries_.emplace_back(place(a), place(b), k(a, b));
        // Drilling spins whose mean vanishes in all elements are free; a little holds them.
        if (a >= 12) entries_.emplace_back(place(a), place(a), 1e-8 * bending);
      }
    }
  }
  void fix(int node, int component) { fixed_[index(6 * node + component)] = true; }
  void load(int node, int component, double value) { load_[6 * node + component] += value; }

  /// Displacements and rotations, six a node.
  Eigen::VectorXd solve() {
    std::vector<Eigen::Triplet<double>> kept;
    for (const auto& t : entries_)
      if (!fixed_[index(t.row())] && !fixed_[index(t.col())]) kept.push_back(t);
    for (Eigen::Index k = 0; k < load_.size(); ++k)
      if (fixed_[index(k)]) {
        kept.emplace_back(static_cast<int>(k), static_cast<int>(k), 1.0);
        load_[k] = 0;
      }
    Eigen::SparseMatrix<double> matrix(load_.size(), load_.size());
    matrix.setFromTriplets(kept.begin(), kept.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
    EXPECT_EQ(factor.info(), Eigen::Success);
    return factor.solve(load_);
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd load_;
  std::vector<bool> fixed_;
};

}  // namespace brio
