#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace taut::fuzz
{
/** The inputs that the targets begin with: a folder for each target. */
class Seeds
{
 public:
    explicit Seeds(std::filesystem::path root) : root_(std::move(root)) {}

    /** A path for a writer of files. */
    std::string file(const std::string& target, const std::string& name) const
    {
        std::filesystem::create_directories(root_ / target);
        return (root_ / target / name).string();
    }

    template <class Bytes>
    void add(const std::string& target, const std::string& name, const Bytes& content) const
    {
        std::ofstream out(file(target, name), std::ios::binary);
        out.write(
            reinterpret_cast<const char*>(content.data()),
            static_cast<std::streamsize>(content.size()));
        if (!out.flush()) throw std::runtime_error("cannot write a seed of " + target);
    }

 private:
    std::filesystem::path root_;
};

inline std::string contentOf(const std::filesystem::path& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(in), {}};
}

void addImportSeeds(const Seeds& seeds);
void addRawlogSeeds(const Seeds& seeds);
/** Of results, configurations and clouds; `source` is the folder of the tree. */
void addFileSeeds(const Seeds& seeds, const std::filesystem::path& source);
}  // namespace taut::fuzz
