#include "app/model/definitions.h"

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <boost/test/unit_test.hpp>

#include "app/model/gear_system.h"
#include "core/files.h"

namespace annulus {

BOOST_AUTO_TEST_SUITE(definitions)

BOOST_AUTO_TEST_CASE(the_document_is_up_to_date) {
  const std::string text = read_file(std::string(ANNULUS_SOURCE_DIR) + "/docs/definitions.md");
  BOOST_TEST((text == app::definitions_markdown()), "run: annulus explain --definitions > docs/definitions.md");
}

BOOST_AUTO_TEST_CASE(results_use_defined_words) {
  for (const auto& kind : app::system_kinds())
    for (const auto& spec : kind.figures())
      if (!spec.term.empty()) {
        const auto* definition = app::find_definition(spec.term);
        BOOST_TEST(definition, spec.key << " uses " << spec.term);
      }
}

BOOST_AUTO_TEST_CASE(sources_are_references) {
  const std::string references = read_file(std::string(ANNULUS_SOURCE_DIR) + "/docs/references.bib");
  for (const auto& d : app::definitions()) {
    if (d.sources.empty()) continue;
    BOOST_TEST_REQUIRE((d.sources.front() == '[' && d.sources.back() == ']'), d.key);
    const auto key = d.sources.substr(1, d.sources.size() - 2);
    BOOST_TEST(references.find("{" + key + ",") != std::string::npos, key);
  }
}

BOOST_AUTO_TEST_CASE(words_are_found_by_symbol_and_title) {
  for (const auto* word : {"K_γ", "K_gamma", "k_GAMMA", "load_sharing", "Load-sharing factor"}) {
    const auto* definition = app::find_definition(word);
    BOOST_TEST_REQUIRE(definition, word);
    BOOST_TEST(definition->key == "load_sharing");
  }
  BOOST_TEST(app::find_definition("K_V")->key == "dynamic_factor");
  BOOST_TEST(!app::find_definition("K_Q"));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
