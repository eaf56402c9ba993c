// Does not compile: the law announces update_fibre and has update_fiber.
#include "materials/elastic.hpp"

namespace brio {

struct Misspelt {
  static constexpr std::string_view name = "misspelt";
  using Settings = Misspelt;
  static constexpr MaterialTraits traits{.update_fibre = true};
  double density = 1;
  static constexpr auto fields() { return field_table(); }
  template <class T>
  struct History {};
  template <class T>
  ElasticModuli<T> moduli(const History<T>&) const {
    return {T(1.0), T(1.0)};
  }
  template <class T>
  void update_fiber(const FibreTensor<T>&, FibreTensor<T>&, History<T>&) const {}
};

LawList<Elastic, Misspelt> material;

}  // namespace brio
