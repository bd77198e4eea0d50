#include "PageData.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace taut
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRows = 2000;        // of each list
constexpr std::size_t kLongestText = 100'000;  // [bytes] of a file
constexpr std::size_t kLongestLine = 2000;     // [bytes] of all other texts

/** JSON that cannot end the element it stands in. */
std::string dumped(const Json& json)
{
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text)  // these stand in strings only
        if (c == '<')
            safe += "\\u003c";
        else if (c == '>')
            safe += "\\u003e";
        else if (c == '&')
            safe += "\\u0026";
        else
            safe += c;
    return safe;
}

std::string cut(const std::string& text, std::size_t longest = kLongestLine)
{
    return text.size() <= longest ? text : text.substr(0, longest) + "... (cut)";
}

/** Builds the JSON and collects the numbers. */
class Encoder
{
 public:
    explicit Encoder(const Report& report) : report_(report)
    {
        if (!report.path.empty()) begin_ = report.path.front().t;
    }

    PageData encode(const PackedPoints& points)
    {
        origin_ = points.count > 0       ? points.min
                  : report_.path.empty() ? Vector3d(Vector3d::Zero())
                                         : report_.path.front().T_world_imu.p;
        Json j;
        j["title"] = cut(report_.title);
        j["subtitle"] = cut(report_.subtitle);
        j["begin"] = toSeconds(begin_);
        j["origin"] = vector(origin_);
        j["points"] = {
            {"count", points.count},
            {"of", report_.points.size()},
            {"size", vector(points.size)},
            {"max_intensity", points.max_intensity}};
        j["headlines"] = pairs(report_.headlines);
        j["facts"] = tables(report_.facts);
        j["path"] = path();
        j["plots"] = plots(report_.plots);
        j["loops"] = loops();
        j["stretches"] = stretches();
        j["warnings"] = warnings();
        j["texts"] = texts();
        if (report_.accuracy) j["accuracy"] = accuracy(*report_.accuracy);
        return {dumped(j), std::move(numbers_)};
    }

 private:
    static Json vector(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

    double seconds(Time t) const { return toSeconds(t - begin_); }

    /** Where something of the data concerned happened; null: at no time. */
    Json secondsOrNull(Time t) const { return t == 0 ? Json() : Json(seconds(t)); }

    /** Begins a run of numbers. */
    Json reference(std::size_t count) const { return {numbers_.size() / sizeof(float), count}; }

    void number(double value) { appendBytes(numbers_, static_cast<float>(value)); }

    Json numbers(const std::vector<float>& values)
    {
        Json ref = reference(values.size());
        for (const float v : values) appendBytes(numbers_, v);
        return ref;
    }

    Json times(const std::vector<Time>& all)
    {
        Json ref = reference(all.size());
        for (const Time t : all) number(seconds(t));
        return ref;
    }

    /** Of each pose t, x, y, z, qx, qy, qz, qw. */
    Json path()
    {
        Json ref = reference(8 * report_.path.size());
        for (const ReportPose& pose : report_.path)
        {
            number(seconds(pose.t));
            position(pose.T_world_imu.p);
            const Eigen::Quaterniond q(pose.T_world_imu.R);
            for (const double c : {q.x(), q.y(), q.z(), q.w()}) number(c);
        }
        return ref;
    }

    void position(const Vector3d& p)
    {
        for (int axis = 0; axis < 3; axis++) number(p[axis] - origin_[axis]);
    }

    Json plots(const std::vector<ReportPlot>& all)
    {
        Json list = Json::array();
        for (const ReportPlot& plot : all)
        {
            Json j = {{"title", cut(plot.title)},   {"unit", cut(plot.unit)},
                      {"hint", cut(plot.hint)},     {"logarithmic", plot.logarithmic},
                      {"times", times(plot.times)}, {"curves", Json::array()}};
            for (const ReportCurve& curve : plot.curves)
                j["curves"].push_back(curveOf(plot, curve));
            list.push_back(std::move(j));
        }
        return list;
    }

    Json curveOf(const ReportPlot& plot, const ReportCurve& curve)
    {
        const auto fits = [&](const std::vector<float>& v)
        { return v.size() == plot.times.size(); };
        if (!fits(curve.values) || !(curve.half_widths.empty() || fits(curve.half_widths)))
            throw std::invalid_argument(
                "the curve '" + curve.name + "' is not as long as the times of its plot");
        Json j = {{"name", cut(curve.name)}, {"values", numbers(curve.values)}};
        if (!curve.half_widths.empty()) j["half_widths"] = numbers(curve.half_widths);
        return j;
    }

    static Json pairs(const std::vector<std::pair<std::string, std::string>>& all)
    {
        Json list = Json::array();
        for (const auto& [name, value] : all) list.push_back({cut(name), cut(value)});
        return list;
    }

    static Json tables(const std::vector<ReportTable>& all)
    {
        Json list = Json::array();
        for (const ReportTable& table : all)
        {
            Json rows = Json::array();
            for (std::size_t i = 0; i < std::min(table.rows.size(), kMostRows); i++)
                rows.push_back(texts(table.rows[i]));
            list.push_back(
                {{"title", cut(table.title)},
                 {"note", cut(table.note)},
                 {"header", texts(table.header)},
                 {"rows", rows}});
        }
        return list;
    }

    static Json texts(const std::vector<std::string>& all)
    {
        Json list = Json::array();
        for (const std::string& text : all) list.push_back(cut(text));
        return list;
    }

    /** Those that are believed first, so that what is cut is the least interesting. */
    Json loops() const
    {
        Json list = Json::array();
        for (const bool believed : {true, false})
            for (const ReportLoop& loop : report_.loops)
            {
                if (loop.believed != believed || list.size() >= kMostRows) continue;
                list.push_back(
                    {{"name", cut(loop.name)},
                     {"verdict", cut(loop.verdict)},
                     {"reason", cut(loop.reason)},
                     {"believed", loop.believed},
                     {"t_from", seconds(loop.t_from)},
                     {"t_to", seconds(loop.t_to)},
                     {"from", vector(loop.from - origin_)},
                     {"to", vector(loop.to - origin_)},
                     {"gap", std::isfinite(loop.gap) ? Json(loop.gap) : Json()}});
            }
        return {{"of", report_.loops.size()}, {"list", list}};
    }

    Json stretches() const
    {
        Json list = Json::array();
        for (const ReportStretch& s : report_.stretches)
        {
            if (list.size() >= kMostRows) break;
            list.push_back(
                {{"from", seconds(s.from)},
                 {"to", seconds(s.to)},
                 {"cause", cut(s.cause)},
                 {"recovered", s.recovered}});
        }
        return {{"of", report_.stretches.size()}, {"list", list}};
    }

    Json warnings() const
    {
        Json list = Json::array();
        for (const ReportWarnings& kind : report_.warnings)
        {
            if (list.size() >= kMostRows) break;
            Json first = Json::array();
            for (const Warning& w : kind.first)
                first.push_back({{"t", secondsOrNull(w.t)}, {"text", cut(w.text)}});
            list.push_back(
                {{"kind", cut(kind.kind)}, {"count", kind.count}, {"first", std::move(first)}});
        }
        return list;
    }

    Json texts() const
    {
        Json list = Json::array();
        for (const auto& [name, text] : report_.texts)
            list.push_back({cut(name), cut(text, kLongestText)});
        return list;
    }

    Json accuracy(const ReportAccuracy& a)
    {
        Json j = {
            {"headline", cut(a.headline)},
            {"tables", tables(a.tables)},
            {"plots", plots(a.plots)},
            {"path", reference(3 * a.path.size())}};
        for (const Vector3d& p : a.path) position(p);
        return j;
    }

    const Report& report_;
    Time begin_ = 0;
    Vector3d origin_ = Vector3d::Zero();
    std::string numbers_;
};
}  // namespace

PageData pageData(const Report& report, const PackedPoints& points)
{
    return Encoder(report).encode(points);
}

std::string escaped(const std::string& text)
{
    const std::string quoted = dumped(Json(cut(text)));  // replaces what is not UTF-8
    const std::string clean = Json::parse(quoted).get<std::string>();
    std::string safe;
    for (const char c : clean) switch (c)
        {
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '&':
                safe += "&amp;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                safe += c;
        }
    return safe;
}
}  // namespace taut
