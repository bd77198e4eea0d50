#include "taut/trajectory/TrajectoryFile.h"

#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "taut/core/ByteOrderMark.h"
#include "taut/core/writeError.h"

namespace taut
{
namespace
{
std::vector<std::string> wordsOf(const std::string& line, bool commas)
{
    const char* const kBlank = commas ? " \t\r," : " \t\r";
    std::vector<std::string> words;
    for (auto begin = line.find_first_not_of(kBlank); begin != std::string::npos;)
    {
        const auto end = line.find_first_of(kBlank, begin);
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(kBlank, end);
    }
    return words;
}

/** By std::from_chars: independent of the locale. */
double parseNumber(const std::string& word)
{
    const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    double value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (stop != end || (error != std::errc() && error != std::errc::result_out_of_range))
        throw std::invalid_argument("'" + word + "' is not a number");
    if (!std::isfinite(value)) throw std::invalid_argument("'" + word + "' is not finite");
    return value;
}

std::string formatNumber(double value, int decimals)
{
    std::array<char, 400> buffer{};
    const auto result = std::to_chars(
        buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
    return {buffer.data(), result.ptr};
}

/** Calls `body` with the words of every line that holds data; names file and line in its errors.
 * `more`: there may be more columns, and commas part them. A last line that fails and has no end
 * goes to `cut`, if that is there: its writer was killed. */
void forLines(
    const std::string& path, std::size_t columns,
    const std::function<void(const std::vector<std::string>&)>& body,
    const std::function<void(const std::string&)>& cut = {}, bool more = false)
{
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read '" + path + "'");
    std::string line;
    for (std::size_t number = 1; std::getline(file, line); number++)
    {
        if (number == 1) dropByteOrderMark(line);
        const auto words = wordsOf(line, more);
        if (words.empty() || words.front().front() == '#') continue;
        try
        {
            if (words.size() != columns && !(more && words.size() > columns))
                throw std::invalid_argument(
                    std::to_string(columns) + " columns expected, found " +
                    std::to_string(words.size()));
            body(words);
        }
        catch (const std::invalid_argument& e)
        {
            const std::string error = path + ":" + std::to_string(number) + ": " + e.what();
            if (!file.eof() || !cut) throw std::runtime_error(error);
            cut(error);
        }
    }
    if (file.bad()) throw std::runtime_error("error while reading '" + path + "'");
}

/** Files with few decimals are not quite unit: 1 % is allowed, and taken away. */
Matrix3d rotationOf(double qx, double qy, double qz, double qw)
{
    const Eigen::Quaterniond q(qw, qx, qy, qz);
    if (std::abs(q.norm() - 1) > 0.01)
        throw std::invalid_argument(
            "the quaternion has norm " + formatNumber(q.norm(), 6) + ", not 1");
    return q.normalized().toRotationMatrix();
}

/** The seven after the first. */
std::array<double, 7> valuesOf(const std::vector<std::string>& words)
{
    std::array<double, 7> values{};
    for (std::size_t i = 0; i < values.size(); i++) values[i] = parseNumber(words[i + 1]);
    return values;
}

/** One stamp later than the last; the second of two equal ones is dropped with a warning. */
void append(
    const StampedPose& pose, Trajectory& out, const std::string& path, const WarningSink& warn)
{
    if (!out.empty() && pose.t < out.back().t)
        throw std::invalid_argument(
            "time goes backward, from " + formatSeconds(out.back().t) + " to " +
            formatSeconds(pose.t) + " s");
    if (out.empty() || pose.t > out.back().t)
        out.push_back(pose);
    else if (warn)
        warn(
            {pose.t, "repeated_stamp",
             path + ": a second pose at " + formatSeconds(pose.t) + " s is dropped"});
}
}  // namespace

std::string tumLine(const StampedPose& pose)
{
    Eigen::Quaterniond q(pose.T_world_imu.R);
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    std::string line = formatSeconds(pose.t);
    for (int i = 0; i < 3; i++) line += " " + formatNumber(pose.T_world_imu.p[i], 9);
    for (int i = 0; i < 4; i++) line += " " + formatNumber(q.coeffs()[i], 12);
    return line;
}

Trajectory readTum(const std::string& path, const WarningSink& warn)
{
    Trajectory out;
    forLines(
        path, 8,
        [&](const std::vector<std::string>& words)
        {
            const auto v = valuesOf(words);
            append(
                {parseSeconds(words[0]), {rotationOf(v[3], v[4], v[5], v[6]), {v[0], v[1], v[2]}}},
                out, path, warn);
        },
        [&](const std::string& error)
        {
            if (warn)
                warn(
                    {out.empty() ? 0 : out.back().t, "cut_line",
                     error + "; the line has no end and is left out: the writing was cut off"});
        });
    return out;
}

Trajectory readEuroc(const std::string& path, const WarningSink& warn)
{
    Trajectory out;
    forLines(
        path, 8,
        [&](const std::vector<std::string>& words)
        {
            Time t = 0;
            const char* end = words[0].data() + words[0].size();
            const auto [stop, error] = std::from_chars(words[0].data(), end, t);
            if (stop != end || error != std::errc())
                throw std::invalid_argument("'" + words[0] + "' is not a time in nanoseconds");
            const auto v = valuesOf(words);
            append({t, {rotationOf(v[4], v[5], v[6], v[3]), {v[0], v[1], v[2]}}}, out, path, warn);
        },
        {}, true);
    return out;
}

TumWriter::TumWriter(const std::string& path) : path_(path), file_(path)
{
    if (!file_) throw writeError(path);
    file_ << "# timestamp tx ty tz qx qy qz qw\n";
}

void TumWriter::write(const StampedPose& pose)
{
    if (any_ && pose.t <= last_)
        throw std::invalid_argument(
            path_ + ": pose at " + formatSeconds(pose.t) + " s follows one at " +
            formatSeconds(last_) + " s");
    any_ = true;
    last_ = pose.t;
    file_ << tumLine(pose) << '\n';
    flushOrThrow(file_, path_);
}

void TumWriter::close()
{
    flushOrThrow(file_, path_);
    file_.close();
}

void writeTum(const std::string& path, const Trajectory& trajectory)
{
    TumWriter writer(path);
    for (const StampedPose& pose : trajectory) writer.write(pose);
    writer.close();
}

std::vector<Pose> readKitti(const std::string& path)
{
    std::vector<Pose> out;
    forLines(
        path, 12,
        [&](const std::vector<std::string>& words)
        {
            Eigen::Matrix<double, 3, 4> T;
            for (int i = 0; i < 12; i++)
                T(i / 4, i % 4) = parseNumber(words[static_cast<std::size_t>(i)]);
            const Matrix3d R = T.leftCols<3>();
            if ((R.transpose() * R - Matrix3d::Identity()).norm() > 0.01 || R.determinant() < 0)
                throw std::invalid_argument("the left 3x3 part is not a rotation");
            out.push_back({normalizedRotation(R), T.col(3)});
        });
    return out;
}

Trajectory readKitti(const std::string& path, const std::string& times_path)
{
    std::vector<Time> times;
    forLines(
        times_path, 1,
        [&](const std::vector<std::string>& words)
        {
            times.push_back(parseSeconds(words[0]));
            if (times.size() > 1 && times.back() <= times[times.size() - 2])
                throw std::invalid_argument("time does not increase");
        });
    const std::vector<Pose> poses = readKitti(path);
    if (poses.size() != times.size())
        throw std::runtime_error(
            path + " has " + std::to_string(poses.size()) + " poses, " + times_path + " " +
            std::to_string(times.size()) + " times");
    Trajectory out;
    for (std::size_t i = 0; i < poses.size(); i++) out.push_back({times[i], poses[i]});
    return out;
}

std::string kittiLine(const Pose& pose)
{
    std::string line;
    for (int i = 0; i < 12; i++)
        line += formatNumber(i % 4 < 3 ? pose.R(i / 4, i % 4) : pose.p[i / 4], 12) +
                (i < 11 ? " " : "");
    return line;
}

void writeKitti(const std::string& path, const std::vector<Pose>& poses)
{
    std::ofstream file(path);
    if (!file) throw std::runtime_error("cannot write '" + path + "'");
    for (const Pose& pose : poses) file << kittiLine(pose) << '\n';
    file.close();
    if (!file) throw std::runtime_error("cannot write '" + path + "' to its end");
}
}  // namespace taut
