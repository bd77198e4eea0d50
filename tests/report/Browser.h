#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace taut::test
{
/** A chromium without a window, driven through its DevTools protocol over two pipes: see
 * https://chromedevtools.github.io/devtools-protocol. Draws in software. */
class Browser
{
 public:
    static bool isThere();

    /** `folder`: for its profile. Throws std::runtime_error if it cannot be started. */
    explicit Browser(const std::string& folder);
    ~Browser();
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    /** Sends a command and waits for its result. Throws std::runtime_error on an error. */
    nlohmann::json call(
        const std::string& method, nlohmann::json parameters = nlohmann::json::object());

    /** The value of an expression; of what a promise gives. Throws what the script throws. */
    nlohmann::json evaluate(const std::string& expression);

    void resize(int width, int height);
    void setDark(bool dark);

    /** Opens a report and waits until it says that it is ready. The milliseconds it took. */
    double open(const std::string& path);

    void click(double x, double y);

    /** Errors and warnings that the pages left on the console. */
    const std::vector<std::string>& complaints() const { return complaints_; }

 private:
    void attach();
    nlohmann::json receive();
    void note(const nlohmann::json& event);

    pid_t process_ = -1;
    int to_ = -1, from_ = -1;
    int last_id_ = 0;
    std::string session_, received_;
    std::vector<std::string> complaints_;
};
}  // namespace taut::test
