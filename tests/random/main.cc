// Random scenes: do the stated errors cover, do relations between scenes hold, does anything crash?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "tests/random/campaign.h"

int main(int argc, char** argv) {
  using namespace annulus::random;
  CampaignSettings settings{.program = ANNULUS_PROGRAM, .folder = "random_scenes"};
  CLI::App app("Runs pairs of random scenes whose results have to agree, and counts how often they do.");
  app.add_option("scenes", settings.scenes, "Number of scenes")->check(CLI::Range(1, 1000000));
  app.add_option("--first", settings.first_seed, "Seed of the first scene");
  app.add_option("--jobs", settings.jobs, "Pairs at once")->check(CLI::Range(1, 256));
  app.add_option("--seconds", settings.seconds, "Limit of each run");
  app.add_option("--max-time", settings.max_time, "Predicted time above which a scene is left out");
  app.add_option("--relations", settings.relations, "Names of relations; all without");
  app.add_option("--systems", settings.systems, "Kinds with the wanted model (\"planetary, solid\"); all without");
  app.add_option("--folder", settings.folder, "Where scenes and results of pairs that disagree are left");
  app.add_option("--table", settings.table, "File for the tables (Markdown)");
  std::uint64_t show = 0;
  app.add_option("--show", show, "Print the scene of this seed and do nothing else");
  CLI11_PARSE(app, argc, argv);
  try {
    if (show > 0) {
      const auto scene = scene_of_campaign(show);
      std::cout << scene.toml();
      for (const auto& [name, text] : scene.files) std::cout << "\n# ---- " << name << "\n" << text;
      return EXIT_SUCCESS;
    }
    settings.folder = std::filesystem::absolute(settings.folder);
    if (!settings.table.empty()) settings.table = std::filesystem::absolute(settings.table);
    const auto result = run_campaign(settings);
    std::cout << campaign_text(result);
    return passes(result) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
