#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include "temporary_folder.h"

namespace taut::test
{
/** A file of the running test, gone with the object. */
class TemporaryFile
{
 public:
    explicit TemporaryFile(const std::string& content = "", const std::string& name = "file.txt")
        : path_(folder_ / name)
    {
        write(content);
    }

    const std::string& path() const { return path_; }
    void write(const std::string& content) const
    {
        std::ofstream(path_, std::ios::binary) << content;
    }
    std::string content() const
    {
        std::ostringstream out;
        out << std::ifstream(path_, std::ios::binary).rdbuf();
        return out.str();
    }

 private:
    TemporaryFolder folder_;
    std::string path_;
};
}  // namespace taut::test
