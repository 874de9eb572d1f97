#include "core/loaded_library.h"

#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "core/files.h"
#include "core/parallel.h"

namespace annulus {

BOOST_AUTO_TEST_SUITE(loaded_library)

BOOST_AUTO_TEST_CASE(libraries_lie_beside_the_core_and_offer_their_table) {
  BOOST_TEST(loaded_libraries().size() == 3U);
  for (const auto& library : loaded_libraries()) {
    BOOST_TEST(std::filesystem::exists(library.file()), library.file());
    BOOST_TEST(library.table() != nullptr, library.file());
  }
}

BOOST_AUTO_TEST_CASE(a_library_is_loaded_once_whoever_asks) {
  std::vector<const void*> tables(16);
  for_each_task(tables.size(), 4, [&](std::size_t i) { tables[i] = meshing_library.table(); });
  for (const auto* table : tables) BOOST_TEST(table == tables.front());
}

BOOST_AUTO_TEST_CASE(a_missing_library_is_named_with_a_remedy) {
  const LoadedLibrary missing("of_nobody");
  BOOST_CHECK_EXCEPTION((void)missing.table(), FileError, [](const FileError& e) {
    const std::string text = e.what();
    return text.find("libannulus_of_nobody.so") != std::string::npos &&
           text.find("install annulus") != std::string::npos;
  });
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
