#include "GzOutput.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace taut
{
GzOutput::GzOutput(std::string path) : path_(std::move(path)), part_(path_ + ".part")
{
    file_ = gzopen(part_.c_str(), "wb1");
    if (!file_) throwFailed(std::strerror(errno));
    gzbuffer(file_, 1u << 18);
}

GzOutput::~GzOutput()
{
    if (!file_) return;
    gzclose_w(file_);
    std::remove(part_.c_str());
}

void GzOutput::write(const std::vector<std::uint8_t>& bytes)
{
    if (!file_) throw std::logic_error("'" + path_ + "' was closed already");
    if (bytes.empty()) return;
    if (gzwrite(file_, bytes.data(), static_cast<unsigned>(bytes.size())) <= 0)
        throwFailed(std::strerror(errno));
}

void GzOutput::close()
{
    if (!file_) return;
    if (gzclose_w(std::exchange(file_, nullptr)) != Z_OK)
    {
        std::remove(part_.c_str());
        throwFailed("the disk did not take all of it");
    }
    if (std::rename(part_.c_str(), path_.c_str()) != 0) throwFailed(std::strerror(errno));
}

void GzOutput::throwFailed(const std::string& cause) const
{
    throw std::runtime_error("cannot write '" + path_ + "': " + cause);
}
}  // namespace taut
