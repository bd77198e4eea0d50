#include "Browser.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace taut::test
{
namespace
{
using Json = nlohmann::json;
using namespace std::chrono_literals;

constexpr int kPatience = 60'000;  // [ms] for an answer

/** What becomes of the child: chromium reads commands from descriptor 3 and answers on 4. */
[[noreturn]] void becomeBrowser(int commands, int answers, const std::string& folder)
{
    const int in = ::fcntl(commands, F_DUPFD, 10), out = ::fcntl(answers, F_DUPFD, 10);
    ::dup2(in, 3);
    ::dup2(out, 4);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) ::dup2(nowhere, stream);
    const std::string profile = "--user-data-dir=" + folder;
    ::execlp(
        "chromium", "chromium", "--headless", "--no-sandbox", "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader", "--remote-debugging-pipe", "--no-first-run",
        "--disable-dev-shm-usage", "--hide-scrollbars", profile.c_str(), "about:blank", nullptr);
    ::_exit(127);
}
}  // namespace

bool Browser::isThere()
{
    return std::system("command -v chromium > /dev/null 2>&1") == 0;
}

Browser::Browser(const std::string& folder)
{
    std::array<int, 2> commands{}, answers{};
    if (::pipe2(commands.data(), O_CLOEXEC) != 0 || ::pipe2(answers.data(), O_CLOEXEC) != 0)
        throw std::runtime_error("no pipe can be made");
    process_ = ::fork();
    if (process_ == 0) becomeBrowser(commands[0], answers[1], folder);
    ::close(commands[0]);
    ::close(answers[1]);
    to_ = commands[1];
    from_ = answers[0];
    if (process_ < 0) throw std::runtime_error("no process can be started");
    std::signal(SIGPIPE, SIG_IGN);  // of a browser that died: the write fails instead
    attach();
}

Browser::~Browser()
{
    ::close(to_);  // chromium ends when its commands do
    ::close(from_);
    for (int i = 0; i < 100; i++)
    {
        if (::waitpid(process_, nullptr, WNOHANG) != 0) return;
        std::this_thread::sleep_for(50ms);
    }
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
}

void Browser::attach()
{
    const Json target = call("Target.createTarget", {{"url", "about:blank"}});
    session_ = call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}})
                   .at("sessionId");
    for (const char* domain : {"Page", "Runtime", "Log"}) call(std::string(domain) + ".enable");
}

Json Browser::call(const std::string& method, Json parameters)
{
    Json message = {{"id", ++last_id_}, {"method", method}, {"params", std::move(parameters)}};
    if (!session_.empty()) message["sessionId"] = session_;
    const std::string text = message.dump();
    if (::write(to_, text.c_str(), text.size() + 1) != static_cast<ssize_t>(text.size() + 1))
        throw std::runtime_error("the browser takes no commands");
    while (true)
    {
        Json answer = receive();
        if (answer.value("id", 0) != last_id_)
            note(answer);
        else if (answer.contains("error"))
            throw std::runtime_error(method + ": " + answer["error"].dump());
        else
            return answer["result"];
    }
}

Json Browser::receive()
{
    std::size_t end = 0;
    while ((end = received_.find('\0')) == std::string::npos)
    {
        pollfd ready{from_, POLLIN, 0};
        if (::poll(&ready, 1, kPatience) <= 0) throw std::runtime_error("the browser is silent");
        std::array<char, 65536> buffer{};
        const ssize_t n = ::read(from_, buffer.data(), buffer.size());
        if (n <= 0) throw std::runtime_error("the browser has ended");
        received_.append(buffer.data(), static_cast<std::size_t>(n));
    }
    Json message = Json::parse(received_.substr(0, end));
    received_.erase(0, end + 1);
    return message;
}

void Browser::note(const Json& event)
{
    const std::string method = event.value("method", "");
    const Json parameters = event.value("params", Json::object());
    const bool complaint =
        method == "Runtime.exceptionThrown" ||
        (method == "Runtime.consoleAPICalled" &&
         (parameters["type"] == "error" || parameters["type"] == "warning")) ||
        (method == "Log.entryAdded" &&
         (parameters["entry"]["level"] == "error" || parameters["entry"]["level"] == "warning"));
    if (complaint) complaints_.push_back(parameters.dump().substr(0, 2000));
}

Json Browser::evaluate(const std::string& expression)
{
    const Json answer = call(
        "Runtime.evaluate",
        {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    if (answer.contains("exceptionDetails"))
        throw std::runtime_error(answer["exceptionDetails"].dump().substr(0, 2000));
    return answer["result"].value("value", Json());
}

void Browser::resize(int width, int height)
{
    call(
        "Emulation.setDeviceMetricsOverride",
        {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", width < 600}});
}

void Browser::setDark(bool dark)
{
    call(
        "Emulation.setEmulatedMedia",
        {{"features", {{{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}}}}});
}

double Browser::open(const std::string& path)
{
    call("Page.navigate", {{"url", "file://" + path}});
    for (int i = 0; i < 600; i++)
    {
        const Json milliseconds = evaluate("window.tautReport ? tautReport.milliseconds : null");
        if (milliseconds.is_number()) return milliseconds.get<double>();
        std::this_thread::sleep_for(50ms);
    }
    throw std::runtime_error("the page is never ready");
}

void Browser::click(double x, double y)
{
    for (const char* type : {"mousePressed", "mouseReleased"})
        call(
            "Input.dispatchMouseEvent",
            {{"type", type}, {"x", x}, {"y", y}, {"button", "left"}, {"clickCount", 1}});
}
}  // namespace taut::test
