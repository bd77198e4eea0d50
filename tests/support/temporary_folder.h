#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace taut::test
{
/** A folder of the running test alone; gone with the object. */
class TemporaryFolder
{
 public:
    TemporaryFolder()
    {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        std::string name = "taut_" + std::to_string(::getpid()) + "_" + test->test_suite_name() +
                           "_" + test->name();
        for (char& c : name)
            if (c == '/') c = '_';  // of a test with parameters
        path_ = std::filesystem::temp_directory_path() / name;
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    /** Path of a file in it. */
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
    std::filesystem::path path_;
};
}  // namespace taut::test
