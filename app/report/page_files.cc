#include <fmt/format.h>

#include <cctype>
#include <set>
#include <vector>

#include "app/report/page.h"
#include "core/files.h"

namespace annulus::app {

namespace {

/// "Mean mesh stiffness, N/mm" -> "mean_mesh_stiffness_n_mm"
std::string slug(const std::string& title) {
  constexpr std::size_t longest = 60;
  std::string result;
  for (const char c : title) {
    const auto u = static_cast<unsigned char>(c);
    if (u < 128 && std::isalnum(u) != 0)
      result += static_cast<char>(std::tolower(u));
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  result = result.substr(0, longest);
  while (!result.empty() && result.back() == '_') result.pop_back();
  return result;
}

}  // namespace

void write_report(const std::filesystem::path& file, const Page& page, const std::string& pictures) {
  const auto made = rendered(page);
  write_file(file, made.html);
  const auto folder = file.parent_path() / pictures;
  std::set<std::filesystem::path> names;
  for (const auto& p : made.pictures) {
    const auto title = slug(p.label);
    const auto name =
        fmt::format("{:02}_{}{}.svg", names.size() + 1, slug(p.section), title.empty() ? "" : "_" + title);
    std::filesystem::create_directories(folder);
    write_file(folder / name, p.svg);
    names.insert(name);
  }
  // Those of an earlier page. Another run may be at work here: what it makes or removes meanwhile is its own.
  std::error_code ignored;
  std::vector<std::filesystem::path> old;
  for (std::filesystem::directory_iterator at(folder, ignored), end; at != end; at.increment(ignored))
    if (at->path().extension() == ".svg" && names.count(at->path().filename()) == 0) old.push_back(at->path());
  for (const auto& picture : old) std::filesystem::remove(picture, ignored);
}

}  // namespace annulus::app
