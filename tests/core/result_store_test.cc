#include "core/result_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.h"
#include "core/file_lock.h"
#include "core/file_set.h"
#include "core/files.h"
#include "core/log.h"
#include "tests/temporary_folder.h"

namespace annulus {

namespace {

using Packing = ResultStore::Packing;

struct StoreFolder : test::TemporaryFolder {
  explicit StoreFolder(const std::string& name) : TemporaryFolder("result_store_" + name) {
    log::set_level(log::Level::quiet);
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> result;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path()))
      if (entry.is_regular_file()) result.push_back(entry.path());
    return result;
  }
  [[nodiscard]] std::uintmax_t bytes() const {
    std::uintmax_t sum = 0;
    for (const auto& file : files()) sum += std::filesystem::file_size(file);
    return sum;
  }
};

std::string long_text() {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += std::to_string(i * i) + ",";
  return text;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(result_store)

BOOST_AUTO_TEST_CASE(content_comes_back_byte_by_byte) {
  const StoreFolder folder("content");
  const ResultStore store(folder.path(), "program");
  const std::string binary("\0\n\xff#\r", 5);
  for (const auto packing : {Packing::compressed, Packing::plain}) {
    for (const auto& content : {std::string(), binary, long_text()}) {
      store.keep("word", "inputs", content, packing);
      BOOST_TEST((store.find("word", "inputs") == content));
    }
  }
  store.keep("small", "inputs", long_text());
  BOOST_TEST(std::filesystem::file_size(folder.files().front()) < long_text().size());
}

BOOST_AUTO_TEST_CASE(other_inputs_kinds_and_programs_are_other_results) {
  const StoreFolder folder("other");
  const ResultStore store(folder.path(), "program");
  store.keep("word", "inputs", "content");
  BOOST_TEST(!store.find("word", "input"));
  BOOST_TEST(!store.find("words", "inputs"));
  BOOST_TEST(!ResultStore(folder.path(), "another").find("word", "inputs"));
  BOOST_TEST(ResultStore(folder.path(), "program").find("word", "inputs").has_value());
}

BOOST_AUTO_TEST_CASE(every_damage_is_noticed) {
  const StoreFolder folder("damage");
  const ResultStore store(folder.path(), "program");
  for (const auto packing : {Packing::compressed, Packing::plain}) {
    const auto keep = [&] { store.keep("word", "inputs", "some content, and more of it", packing); };
    keep();
    const auto file = folder.files().front();
    const auto whole = read_file(file);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (int bit = 0; bit < 8; ++bit) {
        auto damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
        write_file(file, damaged);
        BOOST_TEST(!store.find("word", "inputs"), at << " " << bit);
        BOOST_TEST(!std::filesystem::exists(file));  // and none is read twice
      }
      write_file(file, whole.substr(0, at));
      BOOST_TEST(!store.find("word", "inputs"), at);
    }
    write_file(file, whole + "x");
    BOOST_TEST(!store.find("word", "inputs"));
    // Sizes that no memory has.
    const auto size = fmt::format(" {} ", std::string("some content, and more of it").size());
    for (const char* huge : {"99999999999999999", "9999999999999999999"}) {
      auto damaged = whole;
      damaged.replace(whole.find(size), size.size(), fmt::format(" {} ", huge));
      write_file(file, damaged);
      BOOST_TEST(!store.find("word", "inputs"), huge);
      BOOST_TEST(!std::filesystem::exists(file));
    }
    // Under the name of another result.
    keep();
    store.keep("word", "other", "other content", packing);
    for (const auto& other : folder.files())
      if (other != file) std::filesystem::copy_file(file, other, std::filesystem::copy_options::overwrite_existing);
    BOOST_TEST(!store.find("word", "other"));
    BOOST_TEST(store.find("word", "inputs").has_value());
  }
}

BOOST_AUTO_TEST_CASE(the_folder_keeps_to_its_size) {
  const StoreFolder folder("size");
  constexpr std::uintmax_t most = 2000;
  const ResultStore store(folder.path(), "program", most);
  const std::string content(300, 'x');
  for (int i = 0; i < 40; ++i) {
    store.keep("word", std::to_string(i), content, Packing::plain);
    BOOST_TEST(folder.bytes() <= most);
    BOOST_TEST(store.find("word", std::to_string(i)).has_value());  // the newest one stays
  }
  // Another process starts with what it finds.
  const ResultStore later(folder.path(), "program", most);
  later.keep("word", "more", content, Packing::plain);
  BOOST_TEST(folder.bytes() <= most);
  store.keep("word", "large", std::string(most, 'x'), Packing::plain);
  BOOST_TEST(folder.files().empty());
}

BOOST_AUTO_TEST_CASE(what_cannot_be_written_is_not_cached) {
  const StoreFolder folder("nowhere");
  write_file(folder.path() / "file", "no folder");
  const ResultStore store(folder.path() / "file", "program");
  store.keep("word", "inputs", "content");
  BOOST_TEST(!store.find("word", "inputs"));
}

BOOST_AUTO_TEST_CASE(the_same_is_made_once) {
  const StoreFolder folder("once");
  const ResultStore store(folder.path(), "program");
  std::atomic<int> made{0}, used{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      store.find_or_make(
          "word", "inputs", Packing::plain, [&](const std::string& content) { used += content == "content" ? 1 : 0; },
          [&] {
            ++made;
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            return std::string("content");
          });
    });
  for (auto& thread : threads) thread.join();
  BOOST_TEST(made == 1);
  BOOST_TEST(used == 7);
}

BOOST_AUTO_TEST_CASE(contents_and_clearing) {
  const StoreFolder folder("contents");
  const ResultStore store(folder.path(), "program");
  store.keep("b", "1", "content", Packing::plain);
  store.keep("b", "2", "content", Packing::plain);
  store.keep("a", "1", "content", Packing::plain);
  write_file(folder.path() / "notes.txt", "of the user");
  const auto contents = ResultStore::contents(folder.path());
  BOOST_TEST_REQUIRE(contents.size() == 2U);
  BOOST_TEST(contents[0].kind == "a");
  BOOST_TEST(contents[1].results == 2U);
  BOOST_TEST(contents[1].bytes == 2 * contents[0].bytes);
  ResultStore::clear(folder.path());
  BOOST_TEST(ResultStore::contents(folder.path()).empty());
  BOOST_TEST(folder.files().size() == 1U);
  BOOST_TEST(ResultStore::contents(folder.path() / "none").empty());
}

BOOST_AUTO_TEST_CASE(sets_of_files) {
  const StoreFolder folder("sets"), other("sets_other");
  const FileSet files = {{"a.csv", "1,2\n"}, {"mesh/b.svg", std::string("\0x", 2)}, {"gone.csv", std::nullopt}};
  write_file(other.path() / "gone.csv", "of an earlier run");
  for (const auto* out : {&folder, &other}) {
    write_files(files, out->path());
    BOOST_TEST((read_files(out->path(), {"a.csv", "mesh/b.svg", "gone.csv"}) == files));
  }
  // A file that is right already is not touched.
  const auto file = folder.path() / "a.csv";
  const auto before = std::filesystem::last_write_time(file) - std::chrono::hours(1);
  std::filesystem::last_write_time(file, before);
  write_files(files, folder.path());
  BOOST_TEST((std::filesystem::last_write_time(file) == before));
}

BOOST_AUTO_TEST_CASE(it_looks_in_other_folders_and_leaves_them_alone) {
  const StoreFolder folder("others");
  const auto own = folder.path() / "own", first = folder.path() / "first", second = folder.path() / "second";
  ResultStore(first, "program").keep("word", "a", "of the first");
  ResultStore(first, "program").keep("word", "b", "b of the first");
  ResultStore(second, "program").keep("word", "a", "of the second");
  const ResultStore store(own, "program", ResultStore::usual_most_bytes, {first, second});
  BOOST_TEST((store.find("word", "a") == "of the first"));
  BOOST_TEST(!store.find_own("word", "a"));
  store.keep("word", "a", "own");
  BOOST_TEST((store.find("word", "a") == "own"));
  BOOST_TEST((store.find_own("word", "a") == "own"));
  BOOST_TEST((store.find_others("word", "a") == std::vector<std::string>{"of the first", "of the second"}));
  BOOST_TEST((store.find("word", "b") == "b of the first"));
  BOOST_TEST(store.find_others("word", "c").empty());
  BOOST_TEST((ResultStore(first, "program").find("word", "a") == "of the first"));
  BOOST_TEST(!ResultStore(own, "program").find("word", "b"));
}

BOOST_AUTO_TEST_CASE(a_lock_lets_in_one_at_a_time) {
  const StoreFolder folder("lock");
  const auto file = folder.path() / "lock";
  std::atomic<int> inside{0}, most{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      const FileLock lock(file);
      const int now = ++inside;
      most = std::max(most.load(), now);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      --inside;
    });
  for (auto& thread : threads) thread.join();
  BOOST_TEST(most == 1);
  BOOST_CHECK_THROW(FileLock(folder.path() / "none" / "lock"), FileError);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
