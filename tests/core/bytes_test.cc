#include "core/bytes.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

namespace annulus {

namespace {

struct Inner {
  std::optional<double> number;
  std::map<std::string, std::optional<std::string>> texts;
};

struct Outer {
  bool flag = false;
  std::vector<Inner> list;
  Eigen::MatrixXd matrix;
  std::shared_ptr<const Inner> shared;
};

}  // namespace

ANNULUS_MEMBERS(Inner, number, texts);
ANNULUS_MEMBERS(Outer, flag, list, matrix, shared);

BOOST_AUTO_TEST_SUITE(bytes)

BOOST_AUTO_TEST_CASE(values_survive_bit_by_bit) {
  Outer value{.flag = true,
              .list = {{.number = std::nan(""), .texts = {{"a", "1"}, {"b", std::nullopt}}}, {}},
              .matrix = Eigen::MatrixXd::Random(2, 3),
              .shared = std::make_shared<Inner>(Inner{.number = -INFINITY, .texts = {}})};
  const auto bytes = to_bytes(value);
  const auto back = from_bytes<Outer>(bytes);
  BOOST_TEST(back.flag);
  BOOST_TEST_REQUIRE(back.list.size() == 2U);
  BOOST_TEST(std::isnan(*back.list[0].number));
  BOOST_TEST((back.list[0].texts == value.list[0].texts));
  BOOST_TEST(!back.list[1].number.has_value());
  BOOST_TEST((back.matrix == value.matrix));
  BOOST_TEST(*back.shared->number == -INFINITY);
  BOOST_TEST(to_bytes(back) == bytes);
  BOOST_CHECK_THROW((void)from_bytes<Outer>(bytes.substr(0, bytes.size() - 1)), InternalError);
}

BOOST_AUTO_TEST_CASE(every_member_is_part_of_an_identity) {
  Outer value{.list = {{}}};
  const auto before = to_bytes(value);
  value.list[0].texts["a"] = std::nullopt;
  BOOST_TEST(to_bytes(value) != before);
}

BOOST_AUTO_TEST_CASE(tables_and_figures_keep_all_digits) {
  const auto entry = [](double k, const ErrorParts& parts) {
    return StiffnessEntry{1e-6, 1e-6 + 1e4 / k, k, 2 * k, 0.01, parts};
  };
  StiffnessTable table("mesh", 2, {0.1}, {1e4}, {entry(1e9 / 3, {.model = 0.01}), entry(1.1e9, {})});
  table.provenance = {{"model", "plane"}};
  const auto back = from_bytes<StiffnessTable>(to_bytes(table));
  BOOST_TEST(back.mesh() == "mesh");
  BOOST_TEST(back.at(0, 1, 0).lte == table.at(0, 1, 0).lte);
  BOOST_TEST(back.at(0, 0, 0).error_parts.model == 0.01);
  BOOST_TEST((back.provenance == table.provenance));
  BOOST_TEST(from_bytes<StiffnessTable>(to_bytes(StiffnessTable())).phases() == 0);
  FigureSet figures;
  figures.set("f", {1.0 / 3, not_known}, {.contact = 0.1});
  const auto same = from_bytes<FigureSet>(to_bytes(figures));
  BOOST_TEST(same.value("f") == 1.0 / 3);
  BOOST_TEST(same.find("f")->parts.contact == 0.1);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
