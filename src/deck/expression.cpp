#include "src/deck/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::array<std::string_view, 4> variable_names{"t", "x", "y", "z"};

/// 0 up to `begin`, 1 from `end` on, and 10 s^3 - 15 s^4 + 6 s^5 between them: first and second derivatives
/// are continuous (the smooth step of Abaqus).
double smooth_step(double value, double begin, double end) {
  if (value <= begin) return 0;
  if (value >= end) return 1;
  const double s = (value - begin) / (end - begin);
  return s * s * s * (10 + s * (6 * s - 15));
}

struct OneArgument {
  const char* name;
  double (*function)(double);
};
struct TwoArguments {
  const char* name;
  double (*function)(double, double);
};

constexpr OneArgument of_one[] = {
    {"sin", [](double x) { return std::sin(x); }},     {"cos", [](double x) { return std::cos(x); }},
    {"tan", [](double x) { return std::tan(x); }},     {"asin", [](double x) { return std::asin(x); }},
    {"acos", [](double x) { return std::acos(x); }},   {"atan", [](double x) { return std::atan(x); }},
    {"sinh", [](double x) { return std::sinh(x); }},   {"cosh", [](double x) { return std::cosh(x); }},
    {"tanh", [](double x) { return std::tanh(x); }},   {"exp", [](double x) { return std::exp(x); }},
    {"log", [](double x) { return std::log(x); }},     {"log10", [](double x) { return std::log10(x); }},
    {"sqrt", [](double x) { return std::sqrt(x); }},   {"abs", [](double x) { return std::abs(x); }},
    {"floor", [](double x) { return std::floor(x); }}, {"ceil", [](double x) { return std::ceil(x); }},
    {"round", [](double x) { return std::round(x); }}};
constexpr TwoArguments of_two[] = {{"atan2", [](double y, double x) { return std::atan2(y, x); }},
                                   {"min", [](double a, double b) { return std::min(a, b); }},
                                   {"max", [](double a, double b) { return std::max(a, b); }},
                                   {"mod", [](double a, double b) { return std::fmod(a, b); }}};

std::string trimmed(const std::string& token) { return token.substr(0, token.find_last_not_of(' ') + 1); }

std::string fault_of(const mu::ParserError& error) {
  std::string token = "'";  // GCC 12 warns of an insertion in front of a text
  token += trimmed(error.GetToken()) + "'";
  switch (error.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
      return token + " means nothing here";
    case mu::ecUNEXPECTED_EOF:
      return "the expression ends too early";
    case mu::ecMISSING_PARENS:
      return "a parenthesis is not closed";
    case mu::ecUNEXPECTED_OPERATOR:
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
    case mu::ecUNEXPECTED_PARENS:
    case mu::ecUNEXPECTED_ARG_SEP:
    case mu::ecUNEXPECTED_ARG:
    case mu::ecUNEXPECTED_STR:
      return token + " cannot stand here";
    case mu::ecTOO_MANY_PARAMS:
      return "the function takes fewer arguments";
    case mu::ecTOO_FEW_PARAMS:
      return "the function takes more arguments";
    case mu::ecEMPTY_EXPRESSION:
      return "the expression is empty";
    case mu::ecSTR_RESULT:
      return "a text cannot stand here; numbers are accepted";
    default:
      return error.GetMsg();
  }
}

bool is_name(const std::string& token) {
  return !token.empty() &&
         (std::isalpha(static_cast<unsigned char>(token.front())) != 0 || token.front() == '_');
}

/// An assignment would change a variable for those that come later.
void refuse_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
      continue;
    }
    if (i > 0 && std::string_view("<>!").find(text[i - 1]) != std::string_view::npos) continue;
    throw ExpressionError(i, "'=' cannot stand here; accepted for a comparison is ==");
  }
}

std::size_t position_of(const mu::ParserError& error, const std::string& text) {
  const int position = error.GetPos();
  // Of a missing end muParser counts what it has added.
  return position < 0 ? 0 : std::min(index(position), text.size());
}

}  // namespace

struct Expression::Parsed {
  mu::Parser parser;
  std::array<double, 4> variable{};
  std::array<bool, 4> used{};
};

Expression::Expression(const std::string& text, Parameters parameters, Variables variables)
    : text_(text), parsed_(std::make_unique<Parsed>()) {
  refuse_assignment(text);
  mu::Parser& parser = parsed_->parser;
  try {
    parser.ClearFun();
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    for (const OneArgument& one : of_one) parser.DefineFun(one.name, one.function);
    for (const TwoArguments& two : of_two) parser.DefineFun(two.name, two.function);
    parser.DefineFun("smooth_step", smooth_step);
    for (const auto& [name, value] : parameters) parser.DefineConst(name, value);
    const std::size_t count = variables == Variables::none ? 0 : variables == Variables::time ? 1 : 4;
    for (std::size_t i = 0; i < count; ++i)
      parser.DefineVar(std::string(variable_names[i]), &parsed_->variable[i]);
    parser.SetExpr(text);
    parser.Eval();
    const auto& used = parser.GetUsedVar();
    for (std::size_t i = 0; i < count; ++i) parsed_->used[i] = used.contains(std::string(variable_names[i]));
  } catch (const mu::ParserError& error) {
    const bool unknown = error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && is_name(error.GetToken());
    throw ExpressionError(position_of(error, text), fault_of(error), unknown ? error.GetToken() : "");
  }
  if (parser.GetNumResults() != 1)
    throw ExpressionError(text.rfind(','), "',' cannot stand here; one number is accepted");
}

Expression::~Expression() = default;

double Expression::at(double time, const Vector3d& position) const {
  parsed_->variable = {time, position[0], position[1], position[2]};
  return parsed_->parser.Eval();
}

bool Expression::uses_time() const { return parsed_->used[0]; }
bool Expression::uses_position() const { return parsed_->used[1] || parsed_->used[2] || parsed_->used[3]; }

std::vector<std::string_view> Expression::constants_and_functions() {
  std::vector<std::string_view> names{"pi"};
  for (const OneArgument& one : of_one) names.push_back(one.name);
  for (const TwoArguments& two : of_two) names.push_back(two.name);
  names.push_back("smooth_step");
  return names;
}

std::vector<std::string_view> Expression::names(Variables variables) {
  const std::ptrdiff_t count = variables == Variables::none ? 0 : variables == Variables::time ? 1 : 4;
  return {variable_names.begin(), variable_names.begin() + count};
}

}  // namespace brio
