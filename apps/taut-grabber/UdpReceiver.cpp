#include "UdpReceiver.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>

namespace taut
{
namespace
{
constexpr int kKernelBuffer =
    16'000'000;  // wanted: a second of an OS1-128; the kernel may give less
constexpr std::size_t kLargestDatagram = 65536;

std::runtime_error failure(const std::string& what)
{
    return std::runtime_error(what + ": " + std::strerror(errno));
}

Time timeOf(const timespec& t)
{
    return static_cast<Time>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}
}  // namespace

UdpReceiver::UdpReceiver(const std::string& address, const std::vector<std::uint16_t>& ports)
    : buffer_(kLargestDatagram)
{
    in_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) != 1)
        throw std::runtime_error("'" + address + "' is no IPv4 address");
    try
    {
        for (const std::uint16_t port : ports) open(parsed.s_addr, port);
    }
    catch (...)
    {
        close();
        throw;
    }
}

UdpReceiver::~UdpReceiver()
{
    close();
}

void UdpReceiver::close()
{
    for (const Socket& socket : sockets_) ::close(socket.file);
}

void UdpReceiver::open(std::uint32_t address, std::uint16_t port)
{
    const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (file < 0) throw failure("cannot open a socket");
    sockets_.push_back({file, port, 0});
    const int on = 1;
    setsockopt(file, SOL_SOCKET, SO_RCVBUF, &kKernelBuffer, sizeof kKernelBuffer);
    setsockopt(file, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    if (setsockopt(file, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0)
        throw failure("the kernel does not stamp datagrams");
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = address;
    at.sin_port = htons(port);
    if (bind(file, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
        throw failure("cannot listen at UDP port " + std::to_string(port));
}

std::optional<UdpDatagram> UdpReceiver::next(std::chrono::milliseconds wait)
{
    std::vector<pollfd> polled;
    for (const Socket& socket : sockets_) polled.push_back({socket.file, POLLIN, 0});
    const int ready = poll(polled.data(), polled.size(), static_cast<int>(wait.count()));
    if (ready < 0 && errno != EINTR) throw failure("cannot wait for datagrams");
    if (ready <= 0) return {};
    for (std::size_t i = 0; i < polled.size(); i++)
        if (polled[i].revents != 0) return receive(sockets_[i]);
    return {};
}

std::optional<UdpDatagram> UdpReceiver::receive(Socket& socket)
{
    sockaddr_in from{};
    iovec piece{buffer_.data(), buffer_.size()};
    alignas(cmsghdr) std::array<char, 256> control{};
    msghdr message{};
    message.msg_name = &from;
    message.msg_namelen = sizeof from;
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const auto bytes = recvmsg(socket.file, &message, MSG_DONTWAIT);
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR || errno == ECONNREFUSED)) return {};
    if (bytes < 0) throw failure("cannot receive at UDP port " + std::to_string(socket.port));

    UdpDatagram datagram;
    datagram.from = ntohl(from.sin_addr.s_addr);
    datagram.from_port = ntohs(from.sin_port);
    datagram.to_port = socket.port;
    datagram.payload.assign(buffer_.begin(), buffer_.begin() + bytes);
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c))
    {
        if (c->cmsg_level != SOL_SOCKET) continue;
        timespec t{};
        if (c->cmsg_type == SO_TIMESTAMPNS)
        {
            std::memcpy(&t, CMSG_DATA(c), sizeof t);
            datagram.captured = timeOf(t);
        }
        if (c->cmsg_type == SO_RXQ_OVFL)
            std::memcpy(&socket.lost, CMSG_DATA(c), sizeof socket.lost);
    }
    return datagram;
}

std::size_t UdpReceiver::lost() const
{
    std::size_t lost = 0;
    for (const Socket& socket : sockets_) lost += socket.lost;
    return lost;
}
}  // namespace taut
