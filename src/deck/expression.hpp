#pragma once
/// Formulas of a deck, `"p0*exp(-t/t0)"`, by muParser: compiled when the deck is read, evaluated in double
/// precision without allocation.

#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/base/tensor.hpp"

namespace brio {

/// What is wrong with an expression.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(std::size_t position, const std::string& fault, std::string unknown = {})
      : std::runtime_error(fault), position_(position), unknown_(std::move(unknown)) {}
  std::size_t position() const { return position_; }       ///< in the text, from 0
  const std::string& unknown() const { return unknown_; }  ///< a name that means nothing; else empty

 private:
  std::size_t position_;
  std::string unknown_;
};

class Expression {
 public:
  using Parameters = std::span<const std::pair<std::string, double>>;
  /// Variables that it may use.
  enum class Variables {
    none,
    time,               ///< t
    time_and_position,  ///< t, x, y, z
  };

  /// \throws ExpressionError if the text is no formula of these names.
  Expression(const std::string& text, Parameters parameters, Variables variables);
  ~Expression();
  Expression(const Expression&) = delete;
  Expression& operator=(const Expression&) = delete;

  /// Not from several threads at once.
  double at(double time, const Vector3d& position = {}) const;

  const std::string& text() const { return text_; }
  bool uses_time() const;
  bool uses_position() const;

  /// Constants and functions, which no parameter may be called by.
  static std::vector<std::string_view> constants_and_functions();
  static std::vector<std::string_view> names(Variables variables);

 private:
  struct Parsed;
  std::string text_;
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace brio
