#include "app/results/vtk_assembly.h"

#include <fmt/format.h>

#include <pugixml.hpp>
#include <sstream>

#include "core/files.h"

namespace annulus::app {

namespace {

pugi::xml_node root_of(pugi::xml_document& document, const char* type, const char* element) {
  auto file = document.append_child("VTKFile");
  file.append_attribute("type") = type;
  file.append_attribute("version") = "1.0";
  return file.append_child(element);
}

void write(const std::filesystem::path& file, const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "  ");
  write_file(file, text.str());
}

}  // namespace

void write_vtm(const std::filesystem::path& file,
               const std::vector<std::pair<std::string, std::filesystem::path>>& parts) {
  pugi::xml_document document;
  auto list = root_of(document, "vtkMultiBlockDataSet", "vtkMultiBlockDataSet");
  unsigned index = 0;
  for (const auto& [name, part] : parts) {
    auto set = list.append_child("DataSet");
    set.append_attribute("index") = index++;
    set.append_attribute("name") = name.c_str();
    set.append_attribute("file") = part.generic_string().c_str();
  }
  write(file, document);
}

void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::filesystem::path>>& steps) {
  pugi::xml_document document;
  auto list = root_of(document, "Collection", "Collection");
  int part = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& [time, at] = steps[i];
    part = i > 0 && steps[i - 1].first == time ? part + 1 : 0;
    auto set = list.append_child("DataSet");
    set.append_attribute("timestep") = fmt::format("{:.17g}", time).c_str();
    set.append_attribute("part") = part;
    set.append_attribute("file") = at.generic_string().c_str();
  }
  write(file, document);
}

}  // namespace annulus::app
