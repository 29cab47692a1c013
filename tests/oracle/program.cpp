// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "program.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

namespace thalweg::oracle {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double order(double a, double b) { return a < b ? -1 : a > b ? 1 : 0; }
double remainder_of(double a, double b) {
  const double rest = std::fmod(a, b);
  return rest < 0 ? rest + std::fabs(b) : rest;
}

double one_operand(std::string_view op, double a) {
  if (op == "neg") return -a;
  if (op == "abs") return std::fabs(a);
  if (op == "sqrt") return std::sqrt(a);
  if (op == "square") return a * a;
  if (op == "floor") return std::floor(a);
  if (op == "ceil") return std::ceil(a);
  if (op == "round") return std::round(a);
  if (op == "sin") return std::sin(a);
  if (op == "cos") return std::cos(a);
  if (op == "tan") return std::tan(a);
  if (op == "asin") return std::asin(a);
  if (op == "acos") return std::acos(a);
  if (op == "atan") return std::atan(a);
  if (op == "exp") return std::exp(a);
  if (op == "ln" || op == "log") return a > 0 ? std::log(a) : kNan;
  if (op == "not") return a == 0 ? 1 : 0;
  throw std::invalid_argument("opcode " + std::string(op));
}

double two_operands(std::string_view op, double a, double b) {
  if (op == "add") return a + b;
  if (op == "sub") return a - b;
  if (op == "mul") return a * b;
  if (op == "div") return b == 0 ? kNan : a / b;
  if (op == "min") return a < b ? a : b;
  if (op == "max") return a < b ? b : a;
  if (op == "atan2") return std::atan2(a + 0.0, b + 0.0);
  if (op == "compare") return order(a, b);
  if (op == "mod") return b == 0 ? kNan : remainder_of(a, b);
  if (op == "and") return a == 0 ? a : b;
  if (op == "or") return a == 0 ? b : a;
  if (op == "pow") return a == 0 && b < 0 ? kNan : std::pow(a, b);
  throw std::invalid_argument("opcode " + std::string(op));
}

bool has_two(std::string_view op) {
  for (const char* two : {"add", "sub", "mul", "div", "min", "max", "atan2", "compare", "mod", "and", "or", "pow"}) {
    if (op == two) return true;
  }
  return false;
}

}  // namespace

double library_function(std::string_view opcode, double a, double b) {
  if (std::isnan(a) || (has_two(opcode) && std::isnan(b))) return kNan;
  return has_two(opcode) ? two_operands(opcode, a, b) : one_operand(opcode, a);
}

Program::Program(std::string_view text) {
  std::map<std::string, int> names;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, first, second;
    Step step;
    if (!(words >> name) || name[0] == '#') continue;
    if (!(words >> step.opcode)) throw std::invalid_argument(line);
    words >> first >> second;
    if (step.opcode == "const") {
      step.constant = std::stod(first);
    } else if (step.opcode.rfind("var-", 0) != 0) {
      step.a = names.at(first);
      if (!second.empty()) step.b = names.at(second);
    }
    names[name] = static_cast<int>(steps_.size());
    steps_.push_back(std::move(step));
  }
  if (steps_.empty()) throw std::invalid_argument("no steps");
}

template <class Number>
Number Program::evaluate(Number x, Number y, Number z) const {
  std::vector<Number> values(steps_.size());
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    if (step.opcode == "const") {
      values[i] = static_cast<Number>(step.constant);
    } else if (step.opcode[0] == 'v') {
      values[i] = step.opcode == "var-x" ? x : step.opcode == "var-y" ? y : z;
    } else {
      const auto a = static_cast<double>(values[static_cast<std::size_t>(step.a)]);
      const auto b = step.b < 0 ? 0.0 : static_cast<double>(values[static_cast<std::size_t>(step.b)]);
      values[i] = static_cast<Number>(library_function(step.opcode, a, b));
    }
  }
  return values.back();
}
template double Program::evaluate(double, double, double) const;
template float Program::evaluate(float, float, float) const;

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string random_program(Random& random, int steps, bool with_functions, int dimension) {
  static constexpr const char* kArithmetic[] = {"neg", "abs", "square", "sqrt", "add", "sub", "mul", "min", "max"};
  static constexpr const char* kFunctions[] = {"sin",   "cos",     "tan",   "asin", "acos", "atan", "exp", "ln",
                                               "floor", "ceil",    "round", "not",  "div",  "mod",  "and", "or",
                                               "atan2", "compare", "sin",   "cos",  "exp",  "atan"};
  std::ostringstream text;
  text << "x var-x\ny var-y\n";
  std::vector<std::string> names = {"x", "y"};
  if (dimension == 3) {
    text << "z var-z\n";
    names.push_back("z");
  }
  for (int i = 0; i < steps; ++i) {
    const std::string name = "s" + std::to_string(i);
    // Recent results more often than old ones, so that the last step depends on many.
    const auto operand = [&] {
      const std::size_t back = random.index(random.chance(0.6) ? std::min<std::size_t>(names.size(), 3) : names.size());
      return names[names.size() - 1 - back];
    };
    if (random.chance(0.2)) {
      text << name << " const " << (random.chance(0.3) ? std::round(random.uniform(-3, 3)) : random.uniform(-2, 2))
           << "\n";
    } else {
      const bool function = with_functions && random.chance(0.4);
      const std::string op = function ? kFunctions[random.index(std::size(kFunctions))]
                                      : kArithmetic[random.index(std::size(kArithmetic))];
      text << name << ' ' << op << ' ' << operand();
      if (has_two(op)) text << ' ' << operand();
      text << "\n";
    }
    names.push_back(name);
  }
  text << "end sub " << names.back() << ' ' << names[names.size() - 2] << "\n";
  return text.str();
}

}  // namespace thalweg::oracle
