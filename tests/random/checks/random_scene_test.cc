#include "tests/random/random_scene.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <map>
#include <set>

#include "app/model/gear_system.h"
#include "app/scene/scene.h"
#include "app/scene/scene_kind.h"
#include "core/errors.h"
#include "core/files.h"
#include "tests/random/relations.h"
#include "tests/temporary_folder.h"

namespace annulus::test {

using namespace annulus::random;

BOOST_AUTO_TEST_SUITE(random_scene)

BOOST_AUTO_TEST_CASE(a_seed_is_a_scene) {
  BOOST_TEST(random::random_scene(7).toml() == random::random_scene(7).toml());
  BOOST_TEST(random::random_scene(7).toml() != random::random_scene(8).toml());
}

BOOST_AUTO_TEST_CASE(every_key_of_every_kind_is_drawn) {
  std::map<std::string, std::set<std::string>> drawn;
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    const auto scene = random::random_scene(seed);
    for (const auto& table : app::schema(scene.kind))
      for (const auto& p : table.parameters)
        if (scene.draft.find(p.key()) != nullptr) drawn[scene.kind].insert(p.key());
  }
  const auto excused = [](const std::string& key) {
    return std::any_of(undrawn_keys().begin(), undrawn_keys().end(), [&](const auto& undrawn) {
      const auto& name = undrawn.first;
      return key == name || (name.starts_with("*.") && key.ends_with(name.substr(1))) ||
             (name.ends_with(".*") && key.starts_with(name.substr(0, name.size() - 1)));
    });
  };
  for (const auto& kind : app::stage_kinds())
    for (const auto& table : app::schema(kind)) {
      if (!app::scene_kind(kind).gears) continue;  // trains are made of files
      if (table.role == app::Table::Role::study) continue;
      for (const auto& p : table.parameters)
        BOOST_TEST((excused(p.key()) || drawn[kind].contains(p.key())), kind << ": no scene has " << p.key());
    }
}

BOOST_AUTO_TEST_CASE(most_scenes_can_be_made) {
  constexpr int tried = 300;
  int made = 0;
  for (std::uint64_t seed = 1; seed <= tried; ++seed) {
    try {
      const auto scene = app::parse_scene(random::random_scene(seed).toml(), "scene.toml");
      app::check_stage(scene);
      ++made;
    } catch (const InputError& error) {
      BOOST_TEST_MESSAGE(error.what());
    }
  }
  BOOST_TEST(made > 0.85 * tried);
}

BOOST_AUTO_TEST_CASE(most_trains_can_be_made) {
  constexpr int tried = 40;
  int made = 0;
  for (std::uint64_t seed = 1; seed <= tried; ++seed) {
    const auto train = random::random_train(seed);
    BOOST_TEST(train.toml() == random::random_train(seed).toml());
    const TemporaryFolder folder("random_train");
    for (const auto& [name, text] : train.files) write_file(folder.path() / name, text);
    write_file(folder.path() / "scene.toml", train.toml());
    try {
      app::check_stage(app::read_scene(folder.path() / "scene.toml"));
      ++made;
    } catch (const InputError& error) {
      BOOST_TEST_MESSAGE(error.what());
    }
  }
  BOOST_TEST(made > 0.7 * tried);
}

BOOST_AUTO_TEST_CASE(a_campaign_draws_trains_and_changes_none_of_their_keys) {
  for (std::uint64_t seed = 1; seed <= 32; ++seed) {
    const auto scene = random::scene_of_campaign(seed);
    BOOST_TEST((scene.kind == "train") == (seed % 16 == 5));
    if (scene.files.empty()) continue;
    int pairs = 0;
    for (const auto& relation : random::relations()) pairs += random::pair_of(relation, scene).has_value() ? 1 : 0;
    BOOST_TEST(pairs == 3);  // two accuracies, reused, two threads
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::test
