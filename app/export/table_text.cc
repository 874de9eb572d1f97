#include "app/export/table_text.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace annulus::app {

namespace {

struct TableColumn {
  const char *name, *unit, *what;
  double StiffnessEntry::*value;
};
constexpr std::array<TableColumn, 4> quantities = {
    {{"unloaded_te_m", "m", "unloaded transmission error", &StiffnessEntry::unloaded_te},
     {"lte_m", "m", "loaded transmission error", &StiffnessEntry::lte},
     {"stiffness_secant_N_per_m", "N/m", "force over deflection", &StiffnessEntry::stiffness_secant},
     {"stiffness_tangent_N_per_m", "N/m", "derivative of the force by the deflection",
      &StiffnessEntry::stiffness_tangent}}};

/// One whole period with its first point again at the end.
struct Cycles {
  explicit Cycles(const StiffnessTable& t) : table(t) {}
  const StiffnessTable& table;
  [[nodiscard]] int count() const { return table.positions() * table.phases() + 1; }
  [[nodiscard]] double at(int i) const { return static_cast<double>(i) / table.phases(); }
  [[nodiscard]] const StiffnessEntry& entry(int i, std::size_t load) const {
    const int wrapped = i % (table.positions() * table.phases());
    return table.at(wrapped / table.phases(), wrapped % table.phases(), static_cast<int>(load));
  }
};

std::string provenance_lines(const StiffnessTable& table, const char* mark) {
  std::string text = fmt::format("{} annulus: mesh {}\n", mark, table.mesh());
  for (const auto& [key, value] : table.provenance) text += fmt::format("{} {}: {}\n", mark, key, value);
  return text;
}

/// Statements of lines of at most 80 characters, continued by a comma in front.
class Statement {
 public:
  explicit Statement(const std::string& head) : text_(head) {}
  void add(const std::string& word) {
    constexpr std::size_t longest = 78;
    const std::size_t length = text_.size() - line_;
    if (length + word.size() + 2 > longest) {
      text_ += "\n";
      line_ = text_.size();
    }
    text_ += ", " + word;
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
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "#1\n{}", provenance_lines(table, "#"));
  fmt::format_to(
      to,
      "# First column: mesh cycles passed, period {}; the last row repeats the first (Extrapolation.Periodic).\n"
      "# Matrices named after a quantity: first row the loads in N (CombiTable2D).\n"
      "# curves_<i>: columns",
      table.positions());
  fmt::format_to(to, " mesh_cycles");
  for (const auto& q : quantities) fmt::format_to(to, ", {}", q.name);
  fmt::format_to(to, " at a load (CombiTable1D):");
  for (std::size_t l = 0; l < loads.size(); ++l) fmt::format_to(to, " {} {:.6g} N", l + 1, loads[l]);
  fmt::format_to(to, "\n");
  for (const auto& q : quantities) {
    fmt::format_to(to, "# {}: {}, {}\ndouble {}({}, {})\n0", q.name, q.what, q.unit, q.name, cycles.count() + 1,
                   loads.size() + 1);
    for (const double load : loads) fmt::format_to(to, " {:.17g}", load);
    fmt::format_to(to, "\n");
    for (int i = 0; i < cycles.count(); ++i) {
      fmt::format_to(to, "{:.17g}", cycles.at(i));
      for (std::size_t l = 0; l < loads.size(); ++l) fmt::format_to(to, " {:.17g}", cycles.entry(i, l).*q.value);
      fmt::format_to(to, "\n");
    }
  }
  for (std::size_t l = 0; l < loads.size(); ++l) {
    fmt::format_to(to, "double curves_{}({}, {})\n", l + 1, cycles.count(), quantities.size() + 1);
    for (int i = 0; i < cycles.count(); ++i) {
      fmt::format_to(to, "{:.17g}", cycles.at(i));
      for (const auto& q : quantities) fmt::format_to(to, " {:.17g}", cycles.entry(i, l).*q.value);
      fmt::format_to(to, "\n");
    }
  }
  return fmt::to_string(out);
}

std::string adams_text(const StiffnessTable& table) {
  const Cycles cycles(table);
  // Units are those of the dataset, which has to say UNITS/ ... LENGTH=METER, FORCE=NEWTON.
  std::string text = provenance_lines(table, "!") +
                     "! Units: metres and newtons. x: mesh cycles passed, z: load.\n"
                     "! Extrapolate by the period: mod(cycles, " +
                     std::to_string(table.positions()) + ").\n";
  int id = 0;
  for (const auto& q : quantities) {
    text += fmt::format("! {}: {}, {}\n", q.name, q.what, q.unit);
    Statement statement(fmt::format("SPLINE/{}", ++id));
    for (int i = 0; i < cycles.count(); ++i) statement.add(fmt::format("{}{:.12g}", i == 0 ? "X=" : "", cycles.at(i)));
    for (std::size_t l = 0; l < table.loads().size(); ++l) {
      if (table.loads().size() > 1) statement.add(fmt::format("Y={:.12g}", table.loads()[l]));
      for (int i = 0; i < cycles.count(); ++i)
        statement.add(
            fmt::format("{}{:.12g}", i == 0 && table.loads().size() == 1 ? "Y=" : "", cycles.entry(i, l).*q.value));
    }
    text += statement.text();
  }
  return text;
}

std::string simpack_text(const StiffnessTable& table) {
  const Cycles cycles(table);
  const auto& loads = table.loads();
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "{}", provenance_lines(table, "!"));
  fmt::format_to(to, "header.begin\n  file.type    = 'afs'\n  file.version = 1.0\nheader.end\n\narrfunc.begin\n");
  fmt::format_to(to, "  type         = 'z(xi,yj)'\n");
  for (std::size_t k = 0; k < quantities.size(); ++k)
    fmt::format_to(to, "  name({})      = '{}'    ! {}\n", k + 1, quantities[k].name, quantities[k].what);
  fmt::format_to(to,
                 "  eval.type    = 'linear-linear'\n  x.unit       = '-'    ! mesh cycles passed, period {}\n"
                 "  y.unit       = 'N'    ! load\n",
                 table.positions());
  for (std::size_t k = 0; k < quantities.size(); ++k)
    fmt::format_to(to, "  z.unit({})    = '{}'\n", k + 1, quantities[k].unit);
  fmt::format_to(to, "  data.begin\n    x.begin\n");
  for (int i = 0; i < cycles.count(); ++i) fmt::format_to(to, "      {:.17g}\n", cycles.at(i));
  fmt::format_to(to, "    x.end\n    y.begin\n");
  for (const double load : loads) fmt::format_to(to, "      {:.17g}\n", load);
  fmt::format_to(to, "    y.end\n");
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    fmt::format_to(to, "    z({}).begin    ! a row per x, a column per y\n", k + 1);
    for (int i = 0; i < cycles.count(); ++i) {
      fmt::format_to(to, "     ");
      for (std::size_t l = 0; l < loads.size(); ++l)
        fmt::format_to(to, " {:.17g}", cycles.entry(i, l).*quantities[k].value);
      fmt::format_to(to, "\n");
    }
    fmt::format_to(to, "    z({}).end\n", k + 1);
  }
  fmt::format_to(to, "  data.end\narrfunc.end\n");
  return fmt::to_string(out);
}

}  // namespace annulus::app
