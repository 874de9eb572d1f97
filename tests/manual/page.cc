#include "page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace annulus::manual {

namespace {

struct Layer {
  const char *folder, *title;
};
constexpr Layer layers[] = {{"geometry", "Gears and meshes"},
                            {"fem", "Bodies, contact, stiffness"},
                            {"core", "Tables between the layers"},
                            {"dynamics", "Lumped dynamics"},
                            {"verification", "Whole cases"}};

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string sentence(const std::string& name) {
  auto text = words(name);
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// For a table's cell.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
  return text;
}

/// With the digits that a tolerance asks for, but seven where it is rounding alone.
std::string value(double x, double tolerance = 0) {
  if (x == 0) return "0";
  const double digits = tolerance > 1e-12 * std::abs(x) ? std::ceil(std::log10(std::abs(x) / tolerance)) + 2 : 7;
  return fmt::format("{:.{}g}", x, static_cast<int>(std::clamp(digits, 4.0, 13.0)));
}

std::string with_unit(const std::string& text, const std::string& unit) {
  if (unit.empty()) return text;
  return text + ' ' + (unit == "um" ? "µm" : unit == "deg" ? "°" : unit);
}

std::string small(double x) { return x == 0 ? "0" : fmt::format("{:.2g}", x); }

std::string row_text(const Row& row) {
  const double off = std::abs(row.computed - row.expected);
  std::string expected, computed, difference, tolerance;
  if (row.kind == "relative") {
    const double size = std::abs(row.expected);
    expected = with_unit(value(row.expected, row.tolerance * size), row.unit);
    computed = value(row.computed, row.tolerance * size);
    difference = off == 0 ? "0" : small(off / size) + " of it";
    tolerance = fmt::format("{:.3g} of it", row.tolerance);
  } else if (row.kind == "absolute") {
    expected = with_unit(value(row.expected, row.tolerance), row.unit);
    computed = row.expected == 0 ? small(row.computed) : value(row.computed, row.tolerance);
    difference = with_unit(small(off), row.unit);
    tolerance = with_unit(fmt::format("{:.3g}", row.tolerance), row.unit);
  } else {
    const bool most = row.kind == "at_most";
    computed = fmt::format("{:.{}g}", row.computed, most && row.computed < 0.1 ? 3 : 5);
    tolerance = with_unit(fmt::format("{} {:.3g}", most ? "at most" : "at least", row.tolerance), row.unit);
  }
  const auto count = row.comparisons > 1 ? fmt::format(" (worst of {})", row.comparisons) : "";
  return fmt::format("| {}{} | {} | {} | {} | {} | {} |\n", cell(row.quantity), count, cell(expected),
                     with_unit(computed, row.unit), difference, tolerance, cell(row.origin));
}

struct Count {
  int suites = 0, cases = 0, recorded = 0, rows = 0, comparisons = 0, pictures = 0;
};

std::string anchor(std::string title) {
  std::string result;
  for (const char c : title)
    if (std::isalnum(static_cast<unsigned char>(c)))
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ' || c == '-')
      result += '-';
  return result;
}

}  // namespace

std::string picture_name(const CaseName& name, std::size_t number) {
  return fmt::format("{}.{}.{}{}.svg", name.layer, name.suite, name.name,
                     number == 0 ? "" : fmt::format("_{}", number + 1));
}

std::string tolerances_name(const std::string& layer, const std::string& suite) {
  return fmt::format("{}.{}.tolerances.svg", layer, suite);
}

std::vector<const Record*> records_of(const std::string& layer, const std::string& suite,
                                      const std::vector<ListedCase>& cases, const Records& records) {
  std::vector<const Record*> found;
  for (const auto& c : cases) {
    const auto record = records.find(c.name);
    if (c.name.layer == layer && c.name.suite == suite && record != records.end() && !record->second.rows.empty())
      found.push_back(&record->second);
  }
  return found;
}

std::string case_section(const CaseName& name, const Record& record) {
  std::string text = fmt::format("**{}** (`{}`)  \nReference: {}\n", record.title, name.text(), record.reference);
  if (!record.rows.empty()) {
    text +=
        "\n| quantity | reference | annulus | difference | tolerance | where the tolerance comes from |\n"
        "|---|---|---|---|---|---|\n";
    for (const auto& row : record.rows) text += row_text(row);
  }
  for (std::size_t i = 0; i < record.pictures.size(); ++i)
    text += fmt::format("\n![{}](verification/{})\n", record.pictures[i].title, picture_name(name, i));
  return text;
}

std::string page(const std::string& introduction, const std::vector<ListedCase>& cases, const Records& records) {
  std::string body;
  std::map<std::string, Count> counts;
  for (const auto& layer : layers) {
    std::string part;
    std::vector<std::string> suites;
    for (const auto& c : cases)
      if (c.name.layer == layer.folder && std::find(suites.begin(), suites.end(), c.name.suite) == suites.end())
        suites.push_back(c.name.suite);
    auto& count = counts[layer.folder];
    for (const auto& suite : suites) {
      std::string recorded, others;
      for (const auto& c : cases) {
        if (c.name.layer != layer.folder || c.name.suite != suite) continue;
        const auto found = records.find(c.name);
        if (found == records.end() && c.label != "verification") continue;
        ++count.cases;
        if (found == records.end()) {
          others += fmt::format("- {} (`{}`)\n", words(c.name.name), c.name.text());
          continue;
        }
        ++count.recorded;
        count.pictures += static_cast<int>(found->second.pictures.size());
        for (const auto& row : found->second.rows) {
          ++count.rows;
          count.comparisons += row.comparisons;
        }
        recorded += '\n' + case_section(c.name, found->second);
      }
      if (recorded.empty() && others.empty()) continue;
      ++count.suites;
      part += fmt::format("\n### {}\n", sentence(suite));
      if (!records_of(layer.folder, suite, cases, records).empty())
        part += fmt::format("\n![{}: share of the tolerance that each comparison takes](verification/{})\n",
                            sentence(suite), tolerances_name(layer.folder, suite));
      part += recorded;
      if (!others.empty()) part += "\nNothing to measure (what is refused, said or named):\n\n" + others;
    }
    if (!part.empty()) body += fmt::format("\n<a id=\"{}\"></a>\n\n## {}\n", anchor(layer.title), layer.title) + part;
  }
  std::string overview =
      "\n| layer | suites | test cases | of these with figures | quantities | comparisons | plots |\n"
      "|---|---|---|---|---|---|---|\n";
  Count all;
  const auto line = [](const std::string& title, const Count& c) {
    return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", title, c.suites, c.cases, c.recorded, c.rows,
                       c.comparisons, c.pictures);
  };
  for (const auto& layer : layers) {
    const auto& c = counts[layer.folder];
    if (c.cases == 0) continue;
    overview += line(fmt::format("<a href=\"#{}\">{}</a>", anchor(layer.title), layer.title), c);
    all.suites += c.suites;
    all.cases += c.cases;
    all.recorded += c.recorded;
    all.rows += c.rows;
    all.comparisons += c.comparisons;
    all.pictures += c.pictures;
  }
  return introduction + overview + line("all", all) + body;
}

}  // namespace annulus::manual
