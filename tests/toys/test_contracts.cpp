// A misspelt member of a law or of an element is no law and no element. Misspelt traits: misspelt/.

#include <gtest/gtest.h>

#include "elements/sweep.hpp"
#include "tests/toys/spring/toy_spring_kernel.hpp"
#include "tests/toys/toy_maxwell.hpp"

namespace brio {
namespace {

/// What every law has.
struct Skeleton {
  static constexpr std::string_view name = "skeleton";
  using Settings = Skeleton;
  double density = 1;
  static constexpr auto fields() { return field_table(); }
  template <class T>
  struct History {};
  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return {T(1.0), T(1.0)};
  }
};

struct Announced : Skeleton {
  static constexpr MaterialTraits traits{.update = true};
  template <class T>
  void update(const SymmetricTensor<T>&, SymmetricTensor<T>&, History<T>&) const {}
};
static_assert(MaterialLaw<Announced>);

struct MisspeltUpdate : Skeleton {
  static constexpr MaterialTraits traits{.update = true};
  template <class T>
  void updaet(const SymmetricTensor<T>&, SymmetricTensor<T>&, History<T>&) const {}
};
static_assert(!MaterialLaw<MisspeltUpdate>);

struct UpdateOfOtherArguments : Skeleton {
  static constexpr MaterialTraits traits{.update = true};
  template <class T>
  void update(const ShellTensor<T>&, ShellTensor<T>&, History<T>&) const {}
};
static_assert(!MaterialLaw<UpdateOfOtherArguments>);

struct NotAnnounced : Announced {
  template <class T>
  void update_fibre(const FibreTensor<T>&, FibreTensor<T>&, History<T>&) const {}
};
static_assert(!MaterialLaw<NotAnnounced>);

struct MisspeltTimeStep : Announced {
  static constexpr MaterialTraits traits{.update = true, .time_step = true};
  double timestep = 0;
};
static_assert(!MaterialLaw<MisspeltTimeStep>);

struct MisspeltHistory : Skeleton {
  static constexpr MaterialTraits traits{.update = true, .equivalent_plastic_strain = true};
  template <class T>
  struct History {
    T equivalent_plastic_strian;
  };
  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return {T(1.0), T(1.0)};
  }
  template <class T>
  void update(const SymmetricTensor<T>&, SymmetricTensor<T>&, History<T>&) const {}
};
static_assert(!MaterialLaw<MisspeltHistory>);

struct MisspeltFailure : Announced {
  static constexpr MaterialTraits traits{.update = true, .failure = true};
  std::optional<Failure> failures{};
};
static_assert(!MaterialLaw<MisspeltFailure>);

struct WithoutTraits : Skeleton {
  template <class T>
  void update(const SymmetricTensor<T>&, SymmetricTensor<T>&, History<T>&) const {}
};
static_assert(!MaterialLaw<WithoutTraits>);

static_assert(ElementKernel<ToySpringKernel, Elastic>);

struct MisspeltStations : ToySpringKernel {
  static constexpr KernelTraits kernel_traits{.stations = true};
  int statoins() const { return 2; }
};
static_assert(!ElementKernel<MisspeltStations, Elastic>);

struct UnannouncedStations : ToySpringKernel {
  int stations() const { return 2; }
};
static_assert(!ElementKernel<UnannouncedStations, Elastic>);

struct TurnsWithoutGyration : ToySpringKernel {
  static constexpr bool rotations = true;
};
static_assert(!ElementKernel<TurnsWithoutGyration, Elastic>);

/// The compiler has judged; this names the suite.
TEST(Contracts, HoldWhereThisCompiles) {
  EXPECT_TRUE((MaterialLaw<ToyMaxwell> && MaterialLaw<Elastic>));
  EXPECT_FALSE((MaterialLaw<MisspeltUpdate>));
}

}  // namespace
}  // namespace brio
