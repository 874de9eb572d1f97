#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "app/scene/scene_schema.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

/// Half of the changes are bytes, as libFuzzer does it; the others keep the scene a scene: another value for a key,
/// another key, a line more or less. Otherwise hardly any input would get past the parser of TOML.
namespace annulus::app {

namespace {

using Random = std::minstd_rand;

std::size_t below(Random& random, std::size_t n) { return n ? random() % n : 0; }

const char* const values[] = {"nan",    "inf",      "-inf",  "-1",         "0",          "1",       "1e-300", "1e300",
                              "-1e300", "5e-324",   "3",     "2147483648", "0.5",        "1e9",     "[]",     "[1]",
                              "[1, 2]", "[[[]]]",   "[nan]", "[1e300]",    "\"\"",       "\"x\"",   "true",   "{}",
                              "{a=1}",  "\"../x\"", "\"/\"", "1979-05-27", "[\"a\", 1]", "\"inf\"", "0x7f",   "20"};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

const Parameter& any_parameter(Random& random) {
  const auto& table = schema()[below(random, schema().size())];
  return table.parameters[below(random, table.parameters.size())];
}

std::string any_value(Random& random, const Parameter& p) {
  switch (below(random, 4)) {
    case 0:
      if (!p.choices.empty()) return '"' + p.choices[below(random, p.choices.size())] + '"';
      return std::to_string(p.low);
    case 1:
      if (p.kind == Parameter::Kind::text || p.kind == Parameter::Kind::texts) {
        const auto text = '"' + any_parameter(random).key() + '"';
        return p.kind == Parameter::Kind::text ? text : '[' + text + ']';
      }
      return std::to_string(p.high);
    case 2: {
      const double low = std::max(p.low, -1e6), high = std::min(p.high, 1e6);
      const double x = low + (high - low) * static_cast<double>(random() % 1000) / 1000;
      return p.kind == Parameter::Kind::integer ? std::to_string(static_cast<long>(x)) : std::to_string(x);
    }
    default:
      return values[below(random, std::size(values))];
  }
}

std::string changed(const std::string& text, Random& random) {
  auto lines = lines_of(text);
  auto& line = lines[below(random, lines.size())];
  const auto equals = line.find('=');
  switch (below(random, 6)) {
    case 0:
    case 1:
    case 2:
      if (equals != std::string::npos) {
        auto name = line.substr(0, equals);
        name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
        const Parameter* found = &any_parameter(random);
        for (const auto& table : schema())
          for (const auto& p : table.parameters)
            if (p.name == name) found = &p;
        line = line.substr(0, equals) + "= " + any_value(random, *found);
      }
      break;
    case 3: {
      const auto& p = any_parameter(random);
      line += "\n" + p.name + " = " + any_value(random, p);
      break;
    }
    case 4: {
      const auto& table = schema()[below(random, schema().size())];
      line = (table.path.empty() ? "" : table.header()) + "\n" + line;
      break;
    }
    default:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(below(random, lines.size())));
  }
  std::string result;
  for (const auto& l : lines) result += l + "\n";
  return result;
}

}  // namespace

}  // namespace annulus::app

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  annulus::app::Random random(seed);
  if (random() % 2) return LLVMFuzzerMutate(data, size, max_size);
  const auto text = annulus::app::changed({reinterpret_cast<const char*>(data), size}, random);
  if (text.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
