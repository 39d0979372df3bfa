#include "planner/cache/answer_cache.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "planner/path/geometry/path_fields.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

ContentKey key_of(std::size_t number) { return content_key("key " + std::to_string(number)); }

std::string answer_of(std::size_t number) {
  return std::string(100 + 37 * number % 5000, static_cast<char>('a' + number % 26)) + std::to_string(number);
}

std::vector<fs::path> kept_files(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

TEST(ContentKeys, DifferWhereOneBitOrTheLengthDiffers) {
  std::vector<ContentKey> keys;
  for (std::size_t length = 0; length < 40; ++length) {
    const std::string zeros(length, '\0');
    keys.push_back(content_key(zeros));
    for (std::size_t bit = 0; bit < 8 * length; ++bit) {
      std::string other = zeros;
      other[bit / 8] = static_cast<char>(1 << bit % 8);
      keys.push_back(content_key(other));
    }
  }
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

TEST(Bytes, APathReadsBackToTheLastBit) {
  const double third = 1.0 / 3;
  Path path;
  path.pieces.push_back(TurnInPlace{{third, 2 * third, 0.1}, -0.7});
  path.pieces.push_back(
      Curve({LinearCurvature({0, 0, third}, 1.7),
             LinearCurvature({1.7 * std::cos(third), 1.7 * std::sin(third), third}, 0.9, 0.0, third)},
            Direction::reverse));
  path.pieces.push_back(Curve({BezierSegment({{{0, 0}, {third, 0.1}, {1, 0.7}, {1.9, third}}})}));
  path.pieces.push_back(Curve({BezierSegment::rational({{{0, 0, 1}, {0.5 * third, 0.1, 0.5}, {1, 1, 1}}})}));
  ByteWriter writer;
  writer(path);
  Path again;
  ByteReader reader(writer.bytes());
  reader(again);
  ASSERT_TRUE(reader.finished());
  ASSERT_EQ(again.pieces.size(), path.pieces.size());
  for (std::size_t k = 0; k < path.pieces.size(); ++k) {
    ASSERT_EQ(piece_length(again.pieces[k]), piece_length(path.pieces[k]));
    for (int i = 0; i <= 50; ++i) {
      const double s = piece_length(path.pieces[k]) * i / 50;
      const PathPoint a = piece_point(path.pieces[k], s), b = piece_point(again.pieces[k], s);
      EXPECT_EQ(a.pose.x_m, b.pose.x_m);
      EXPECT_EQ(a.pose.heading_rad, b.pose.heading_rad);
      EXPECT_EQ(a.curvature_per_m, b.curvature_per_m);
      EXPECT_EQ(a.curvature_slope_per_m2, b.curvature_slope_per_m2);
    }
  }
}

TEST(Bytes, TruncatedAndChangedBytesAreReadSafely) {
  ByteWriter writer;
  writer(std::string("name"), std::vector<double>{1, 2, 3}, std::optional<double>{4},
         std::map<std::string, double>{{"a", 5}});
  std::mt19937 random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bytes = writer.bytes();
    if (trial % 2 == 0) bytes.resize(random() % bytes.size());
    if (!bytes.empty()) bytes[random() % bytes.size()] = static_cast<char>(random());
    std::string name;
    std::vector<double> list;
    std::optional<double> number;
    std::map<std::string, double> map;
    ByteReader reader(bytes);
    reader(name, list, number, map);
    if (trial % 2 == 0) {
      EXPECT_FALSE(reader.finished());
    }
  }
}

TEST(AnswerCache, ComputesOnceAndKeepsWithinItsLimit) {
  AnswerCache cache(100'000);
  const SharedAnswers answers{&cache, key_of(0)};
  int computed = 0;
  const auto ask = [&](double part) {
    return remembered(
        answers, "sum", [&] { return ++computed, part + 1; }, part);
  };
  EXPECT_EQ(ask(1), 2);
  EXPECT_EQ(ask(1), 2);
  EXPECT_EQ(computed, 1);
  EXPECT_EQ(remembered(
                {&cache, key_of(1)}, "sum", [] { return 7.0; }, 1.0),
            7)
      << "another world";
  EXPECT_EQ(remembered(
                answers, "other", [] { return 8.0; }, 1.0),
            8)
      << "another kind of question";
  for (std::size_t k = 0; k < 200; ++k) cache.keep(key_of(k), std::string(1000, 'x'));
  std::size_t kept = 0;
  for (std::size_t k = 0; k < 200; ++k) kept += cache.find(key_of(k)) != nullptr;
  EXPECT_LE(kept, 100u);
  EXPECT_GE(kept, 90u);
  EXPECT_NE(cache.find(key_of(199)), nullptr) << "the most recent one stays";
}

TEST(AnswerCache, DamagedFilesAreReplaced) {
  const ScratchDirectory scratch;
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    DiskStore store(scratch.at("cache"));
    store.keep(key_of(1), answer_of(1));
    const std::vector<fs::path> files = kept_files(scratch.at("cache"));
    ASSERT_EQ(files.size(), 1u);
    ASSERT_EQ(store.find(key_of(1)), answer_of(1));
    const auto size = fs::file_size(files.front());
    if (trial % 2 == 0) {
      fs::resize_file(files.front(), random() % size);
    } else {
      std::fstream file(files.front(), std::ios::in | std::ios::out | std::ios::binary);
      const auto place = static_cast<std::streamoff>(random() % size);
      file.seekg(place);
      const char flipped = static_cast<char>(file.get() ^ (1 << random() % 8));
      file.seekp(place);
      file.put(flipped);
    }
    EXPECT_EQ(store.find(key_of(1)), std::nullopt) << trial;
    // A file in another key's place, whole in itself, is no answer either.
    store.keep(key_of(1), answer_of(1));
    EXPECT_EQ(store.find(key_of(1)), answer_of(1));
    EXPECT_EQ(store.find(key_of(2)), std::nullopt);
  }
}

TEST(AnswerCache, AFileOfAnotherKeyIsIgnored) {
  const ScratchDirectory scratch;
  DiskStore store(scratch.at("cache"));
  store.keep(key_of(1), answer_of(1));
  const fs::path first = kept_files(scratch.at("cache")).front();
  store.keep(key_of(2), answer_of(2));
  for (const fs::path& file : kept_files(scratch.at("cache")))
    if (file != first) fs::copy_file(first, file, fs::copy_options::overwrite_existing);
  EXPECT_EQ(store.find(key_of(2)), std::nullopt);
}

TEST(AnswerCache, EightProcessesShareAFolderThatStaysWithinItsLimit) {
  const ScratchDirectory scratch;
  constexpr std::uint64_t kLimit_bytes = 100'000;
  std::vector<pid_t> children;
  for (unsigned child = 0; child < 8; ++child) {
    const pid_t pid = ::fork();
    ASSERT_GE(pid, 0);
    if (pid == 0) {
      std::mt19937 random(child);
      DiskStore store(scratch.at("cache"), kLimit_bytes);
      bool good = true;
      for (int trial = 0; trial < 400; ++trial) {
        const std::size_t number = random() % 100;
        if (const auto answer = store.find(key_of(number)))
          good &= *answer == answer_of(number);
        else
          store.keep(key_of(number), answer_of(number));
      }
      ::_exit(good ? 0 : 1);
    }
    children.push_back(pid);
  }
  for (const pid_t pid : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(pid, &status, 0), pid);
    EXPECT_EQ(status, 0) << "every answer that was found is the one that was kept";
  }
  std::uint64_t sum_bytes = 0;
  std::size_t drafts = 0;
  for (const fs::path& file : kept_files(scratch.at("cache"))) {
    sum_bytes += fs::file_size(file);
    drafts += file.extension() == ".new";
  }
  EXPECT_EQ(drafts, 0u);
  EXPECT_LE(sum_bytes, 2 * kLimit_bytes) << "each process looks at the size when it wrote a sixteenth";
  EXPECT_GE(sum_bytes, kLimit_bytes / 4);
}

TEST(AnswerCache, AFolderThatCannotBeWrittenKeepsNothing) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("file", "not a folder");
  DiskStore store(file + "/cache");
  store.keep(key_of(1), answer_of(1));
  EXPECT_EQ(store.find(key_of(1)), std::nullopt);
}

TEST(AnswerCache, OtherFilesOfTheFolderAreNeverDeleted) {
  const ScratchDirectory scratch;
  const std::string hex(30, 'a');
  const std::vector<std::string> others{
      "holiday.raw",     "notes.new", "photos/holiday.raw", "ab/notes.txt", "ab/" + hex + ".new.txt",
      "photos/ab/" + hex};
  for (const std::string& name : others) {
    const fs::path file = scratch.at("cache/" + name);
    fs::create_directories(file.parent_path());
    std::ofstream(file) << std::string(20'000, 'x');
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(10'000));
  }
  DiskStore store(scratch.at("cache"), 10'000);
  for (std::size_t k = 0; k < 30; ++k) store.keep(key_of(k), std::string(1000, 'x'));
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(scratch.at("cache/" + name))) << name;
  EXPECT_TRUE(store.find(key_of(29))) << "they do not count against the limit";
  EXPECT_LE(kept_files(scratch.at("cache")).size(), others.size() + 11);
}

TEST(AnswerCache, LeastRecentlyUsedFilesAreDeletedFirst) {
  const ScratchDirectory scratch;
  const auto now = fs::file_time_type::clock::now();
  {
    DiskStore store(scratch.at("cache"));
    for (std::size_t k = 0; k < 20; ++k) store.keep(key_of(k), std::string(1000, 'x'));
    for (const fs::path& file : kept_files(scratch.at("cache")))
      fs::last_write_time(file, now - std::chrono::hours(10));
    EXPECT_TRUE(store.find(key_of(3))) << "use makes it recent";
  }
  DiskStore smaller(scratch.at("cache"), 10'000);
  smaller.keep(key_of(50), std::string(1000, 'x'));
  EXPECT_TRUE(smaller.find(key_of(3)));
  EXPECT_TRUE(smaller.find(key_of(50)));
  EXPECT_LE(kept_files(scratch.at("cache")).size(), 9u);
}

}  // namespace
}  // namespace joulepath
