#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace taut::test
{
/** A file of the running test, gone at its end. */
class TemporaryFile
{
 public:
    explicit TemporaryFile(const std::string& content = "", const std::string& suffix = ".txt")
        : path_(
              ::testing::TempDir() + "taut_" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name() + suffix)
    {
        std::ofstream(path_, std::ios::binary) << content;
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::string& path() const { return path_; }
    std::string content() const
    {
        std::ostringstream out;
        out << std::ifstream(path_, std::ios::binary).rdbuf();
        return out.str();
    }

 private:
    std::string path_;
};
}  // namespace taut::test
