#include "core/csv.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/files.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(csv)

std::string message_of(const std::filesystem::path& file, const std::string& text) {
  annulus::write_file(file, text);
  try {
    (void)annulus::Csv::read(file);
  } catch (const annulus::InputError& error) {
    return error.what();
  }
  return "accepted";
}

BOOST_AUTO_TEST_CASE(every_double_survives_the_round_trip) {
  const annulus::test::TemporaryFolder folder("csv");
  annulus::Csv written;
  written.header = {{"annulus_version", "1"}, {"note", "a: colon, a comma and a # in the value"}};
  written.columns = {"a_m", "b_N"};
  written.rows = {{0.1, 1.0 / 3.0},
                  {std::nextafter(1.0, 2.0), -5e-324},
                  {std::numeric_limits<double>::max(), std::numeric_limits<double>::min()}};
  written.write(folder.path() / "t.csv");
  const auto read = annulus::Csv::read(folder.path() / "t.csv");
  BOOST_TEST(read.columns == written.columns);
  BOOST_TEST((read.header == written.header));
  BOOST_TEST((read.rows == written.rows));  // bitwise: 17 digits identify a double
  BOOST_TEST(read.column("b_N") == 1U);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_written_is_an_input_error) {
  const annulus::test::TemporaryFolder folder("csv");
  annulus::Csv csv;
  csv.columns = {"a,b"};
  BOOST_CHECK_THROW(csv.write(folder.path() / "f"), annulus::InputError);
  csv.columns = {"a"};
  csv.header = {{"key", "two\nlines"}};
  BOOST_CHECK_THROW(csv.write(folder.path() / "f"), annulus::InputError);
  csv.header.clear();
  csv.rows = {{1, 2}};
  BOOST_CHECK_THROW(csv.write(folder.path() / "f"), annulus::InternalError);
  BOOST_TEST(!std::filesystem::exists(folder.path() / "f"));
}

BOOST_AUTO_TEST_CASE(malformed_files_are_refused_with_their_line) {
  const annulus::test::TemporaryFolder folder("csv");
  const auto file = folder.path() / "bad.csv";
  const auto at = [&](int line) { return file.string() + ":" + std::to_string(line) + ": "; };
  BOOST_TEST(message_of(file, "# k: v\na,b\n1,2\n3,x\n") == at(4) + "'x' in column b is not a number");
  BOOST_TEST(message_of(file, "a,b\n1,2 3\n") == at(2) + "'2 3' in column b is not a number");
  BOOST_TEST(message_of(file, "a,b\n1,\n") == at(2) + "'' in column b is not a number");
  BOOST_TEST(message_of(file, "# k: v\na,b\n1,2\n3\n") == at(4) + "1 cells where the header has 2");
  BOOST_TEST(message_of(file, "a,b\n1,2,3\n") == at(2) + "3 cells where the header has 2");
  BOOST_TEST(message_of(file, "# no value\na\n1\n") == at(1) + "expected '# key: value'");
  BOOST_TEST(message_of(file, "a\n1\n\n2\n") == at(4) + "data after an empty line; remove the empty line");
  BOOST_TEST(message_of(file, "# k: v\n") == at(2) + "no line with column names");
  BOOST_CHECK_THROW((void)annulus::Csv::read(folder.path() / "missing.csv"), annulus::InputError);
}

BOOST_AUTO_TEST_CASE(line_ends_and_blanks_of_other_systems_are_accepted) {
  const annulus::test::TemporaryFolder folder("csv");
  annulus::write_file(folder.path() / "dos.csv", "# k: v\r\na, b\r\n1, 2\r\n\r\n");
  const auto csv = annulus::Csv::read(folder.path() / "dos.csv");
  BOOST_TEST(csv.header.at(0).second == "v");
  BOOST_TEST(csv.columns.at(1) == "b");
  BOOST_TEST((csv.rows == std::vector<std::vector<double>>{{1, 2}}));
}

// RFC 4180, section 2: fields with commas or quotes are enclosed in quotes, quotes in them are doubled.
BOOST_AUTO_TEST_CASE(cells_with_text_are_quoted_where_they_have_to_be) {
  using annulus::csv_cell;
  BOOST_TEST(csv_cell("plain text") == "plain text");
  BOOST_TEST(csv_cell("a,b") == "\"a,b\"");
  BOOST_TEST(csv_cell("5\" ring") == "\"5\"\" ring\"");
  BOOST_TEST(csv_cell("two\r\nlines") == "two  lines");
  BOOST_TEST(csv_cell("").empty());
  // Spreadsheets would compute these.
  for (const std::string formula : {"=1+1", "+1", "-1", "@sum(a)", "  =1"})
    BOOST_TEST(csv_cell(formula) == "'" + formula);
  BOOST_TEST(csv_cell("\t=1") == "' =1");
  BOOST_TEST(csv_cell("=\"a\",b") == "\"'=\"\"a\"\",b\"");
  BOOST_TEST(csv_cell("1=1") == "1=1");
  BOOST_TEST(annulus::csv_remark("a\n=b\r\x7f") == "a =b  ");
  BOOST_TEST(annulus::csv_remark("a,=1+1 = a, -2,b") == "a,'=1+1 = a, '-2,b");
  BOOST_TEST(std::stod(csv_cell(0.1 + 0.2)) == 0.1 + 0.2);
  BOOST_TEST(csv_cell(std::numeric_limits<double>::quiet_NaN()).empty());
  BOOST_TEST(csv_cell(-std::numeric_limits<double>::infinity()).empty());
}

BOOST_AUTO_TEST_CASE(a_missing_column_is_named) {
  annulus::Csv csv;
  csv.columns = {"a", "b"};
  BOOST_CHECK_EXCEPTION((void)csv.column("c"), annulus::InputError,
                        [](const auto& e) { return std::string(e.what()) == "no column 'c'; there are: a, b"; });
}

BOOST_AUTO_TEST_SUITE_END()
