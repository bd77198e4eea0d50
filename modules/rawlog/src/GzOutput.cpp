#include "GzOutput.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace taut
{
GzOutput::GzOutput(std::string path) : path_(std::move(path)), part_(path_ + ".part")
{
    const int file = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) throwFailed(std::strerror(errno));
    // What another program is writing is not emptied; what one that was killed left, is.
    if (::flock(file, LOCK_EX | LOCK_NB) != 0 || ::ftruncate(file, 0) != 0)
    {
        const std::string cause =
            errno == EWOULDBLOCK ? "another program is writing it now" : std::strerror(errno);
        ::close(file);
        throwFailed(cause);
    }
    file_ = gzdopen(file, "wb1");
    if (!file_) throwFailed("not enough memory");
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
    errno = 0;
    if (gzclose_w(std::exchange(file_, nullptr)) != Z_OK)
    {
        const std::string cause = errno != 0 ? std::strerror(errno) : "an earlier error";
        std::remove(part_.c_str());
        throwFailed(cause);
    }
    if (std::rename(part_.c_str(), path_.c_str()) != 0) throwFailed(std::strerror(errno));
}

void GzOutput::throwFailed(const std::string& cause) const
{
    throw std::runtime_error("cannot write '" + path_ + "': " + cause);
}
}  // namespace taut
