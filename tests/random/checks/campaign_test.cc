#include "tests/random/campaign.h"

#include <boost/test/unit_test.hpp>

namespace annulus::test {

using namespace annulus::random;

namespace {

CampaignResult with_outside(int values, int outside) {
  CampaignResult result;
  result.relations["two accuracies"].tried = values;
  auto& list = result.results["two accuracies"]["dynamic_factor"].effectivities;
  for (int i = 0; i < values; ++i) list.push_back(i < outside ? 1.5 : 0.5);
  return result;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(campaign)

// Of 1, 20 and 1000 values covered at 95 %, up to 1, 3 and 64 are outside by chance.
BOOST_AUTO_TEST_CASE(coverage_fails_where_chance_does_not_explain_it) {
  BOOST_TEST(passes(with_outside(1, 1)));
  BOOST_TEST(passes(with_outside(20, 3)));
  BOOST_TEST(!passes(with_outside(20, 5)));
  BOOST_TEST(passes(with_outside(1000, 50)));
  BOOST_TEST(!passes(with_outside(1000, 70)));
}

BOOST_AUTO_TEST_CASE(failures_and_broken_relations_fail) {
  auto failed = with_outside(1, 0);
  BOOST_TEST(passes(failed));
  failed.relations["two accuracies"].outcomes[Outcome::failed] = 1;
  BOOST_TEST(!passes(failed));
  auto refused = with_outside(1, 0);
  refused.relations["two accuracies"].outcomes[Outcome::refused] = 1;
  refused.relations["two accuracies"].outcomes[Outcome::over_limit] = 1;
  BOOST_TEST(passes(refused));
  CampaignResult broken;
  broken.relations["two threads"].disagreed = 1;
  BOOST_TEST(!passes(broken));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::test
