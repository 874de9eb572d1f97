#include "app/export/table_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "app/export/named_arrays.h"

namespace annulus::app {

namespace {

/// One whole period with its first point again at the end.
struct Cycles {
  explicit Cycles(const StiffnessTable& t) : table(t) {
    for (int i = 0; i <= t.positions() * t.phases(); ++i) passed.push_back(static_cast<double>(i) / t.phases());
  }

  const StiffnessTable& table;
  std::vector<double> passed{};  ///< mesh cycles

  [[nodiscard]] double value(std::size_t i, std::size_t load, const TableColumn& column) const {
    const int wrapped = static_cast<int>(i) % (table.positions() * table.phases());
    return table.at(wrapped / table.phases(), wrapped % table.phases(), static_cast<int>(load)).*column.value;
  }
  [[nodiscard]] std::vector<double> over_loads(std::size_t i, const TableColumn& column) const {
    std::vector<double> values;
    for (std::size_t l = 0; l < table.loads().size(); ++l) values.push_back(value(i, l, column));
    return values;
  }
};

std::string numbers(const std::vector<double>& values, const char* separator = " ") {
  return fmt::format("{:.17g}", fmt::join(values, separator));
}

std::string provenance_lines(const StiffnessTable& table, const char* mark) {
  std::string text = fmt::format("{} annulus: mesh {}\n", mark, table.mesh());
  for (const auto& [key, value] : table.provenance) text += fmt::format("{} {}: {}\n", mark, key, value);
  return text;
}

/// Statements of lines of at most 80 characters, continued by a comma in front.
class Statement {
 public:
  explicit Statement(const std::string& head) : text_(head) {}
  /// `name`: in front of the first value.
  void add(const char* name, const std::vector<double>& values) {
    constexpr std::size_t longest = 78;
    for (const double value : values) {
      const auto word = fmt::format("{}{:.12g}", name, value);
      if (text_.size() - line_ + word.size() + 2 > longest) {
        text_ += "\n";
        line_ = text_.size();
      }
      text_ += ", " + word;
      name = "";
    }
  }
  [[nodiscard]] std::string text() const { return text_ + "\n"; }

 private:
  std::string text_;
  std::size_t line_ = 0;
};

}  // namespace

std::string modelica_text(const StiffnessTable& table) {
  const Cycles cycles(table);
  const auto& loads = table.loads();
  std::string text = "#1\n" + provenance_lines(table, "#") +
                     fmt::format(
                         "# First column: mesh cycles passed, period {}; the last row repeats the first "
                         "(Extrapolation.Periodic).\n"
                         "# Matrices named after a quantity: first row the loads in N (CombiTable2D).\n"
                         "# curves_<i>: columns mesh_cycles",
                         table.positions());
  for (const auto& c : table_columns) text += fmt::format(", {}", c.name);
  text += " at a load (CombiTable1D):";
  for (std::size_t l = 0; l < loads.size(); ++l) text += fmt::format(" {} {:.6g} N", l + 1, loads[l]);
  text += "\n";
  for (const auto& c : table_columns) {
    text += fmt::format("# {}: {}, {}\ndouble {}({}, {})\n0 {}\n", c.name, c.what, c.unit, c.name,
                        cycles.passed.size() + 1, loads.size() + 1, numbers(loads));
    for (std::size_t i = 0; i < cycles.passed.size(); ++i)
      text += fmt::format("{:.17g} {}\n", cycles.passed[i], numbers(cycles.over_loads(i, c)));
  }
  for (std::size_t l = 0; l < loads.size(); ++l) {
    text += fmt::format("double curves_{}({}, {})\n", l + 1, cycles.passed.size(), table_columns.size() + 1);
    for (std::size_t i = 0; i < cycles.passed.size(); ++i) {
      std::vector<double> row = {cycles.passed[i]};
      for (const auto& c : table_columns) row.push_back(cycles.value(i, l, c));
      text += numbers(row) + "\n";
    }
  }
  return text;
}

std::string adams_text(const StiffnessTable& table, int base_id) {
  const Cycles cycles(table);
  // Units are those of the dataset, which has to say UNITS/ ... LENGTH=METER, FORCE=NEWTON.
  std::string text = provenance_lines(table, "!") + fmt::format(
                                                        "! Units: metres and newtons. x: mesh cycles passed, z: load.\n"
                                                        "! Extrapolate by the period: mod(cycles, {}).\n",
                                                        table.positions());
  const bool one_load = table.loads().size() == 1;
  int id = base_id;
  for (const auto& c : table_columns) {
    Statement statement(fmt::format("SPLINE/{}", id++));
    statement.add("X=", cycles.passed);
    for (std::size_t l = 0; l < table.loads().size(); ++l) {
      if (!one_load) statement.add("Y=", {table.loads()[l]});
      std::vector<double> values;
      for (std::size_t i = 0; i < cycles.passed.size(); ++i) values.push_back(cycles.value(i, l, c));
      statement.add(one_load ? "Y=" : "", values);
    }
    text += fmt::format("! {}: {}, {}\n{}", c.name, c.what, c.unit, statement.text());
  }
  return text;
}

std::string simpack_text(const StiffnessTable& table) {
  const Cycles cycles(table);
  std::string names, units, values;
  int number = 0;
  for (const auto& c : table_columns) {
    ++number;
    names += fmt::format("  name({})      = '{}'    ! {}\n", number, c.name, c.what);
    units += fmt::format("  z.unit({})    = '{}'\n", number, c.unit);
    values += fmt::format("    z({}).begin    ! a row per x, a column per y\n", number);
    for (std::size_t i = 0; i < cycles.passed.size(); ++i)
      values += fmt::format("      {}\n", numbers(cycles.over_loads(i, c)));
    values += fmt::format("    z({}).end\n", number);
  }
  return provenance_lines(table, "!") +
         fmt::format(
             "header.begin\n  file.type    = 'afs'\n  file.version = 1.0\nheader.end\n\narrfunc.begin\n"
             "  type         = 'z(xi,yj)'\n{}"
             "  eval.type    = 'linear-linear'\n  x.unit       = '-'    ! mesh cycles passed, period {}\n"
             "  y.unit       = 'N'    ! load\n{}"
             "  data.begin\n    x.begin\n      {}\n    x.end\n    y.begin\n      {}\n    y.end\n{}"
             "  data.end\narrfunc.end\n",
             names, table.positions(), units, numbers(cycles.passed, "\n      "), numbers(table.loads(), "\n      "),
             values);
}

}  // namespace annulus::app
