#include "taut/graph/G2oFile.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <stdexcept>
#include <vector>

#include "IndexedGraph.h"
#include "taut/core/writeError.h"

namespace taut
{
namespace
{
using Words = std::vector<std::string>;
constexpr const char* kVertex = "VERTEX_SE3:QUAT";
constexpr const char* kEdge = "EDGE_SE3:QUAT";
constexpr const char* kMark = "#taut";

/** From information of theta to that of the quaternion's vector part theta / 2. */
const Vector6d kToQuaternion = (Vector6d() << 1, 1, 1, 2, 2, 2).finished();

Words wordsOf(const std::string& line)
{
    constexpr const char* kBlank = " \t\r";
    Words words;
    for (auto begin = line.find_first_not_of(kBlank); begin != std::string::npos;)
    {
        const auto end = line.find_first_of(kBlank, begin);
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(kBlank, end);
    }
    return words;
}

template <class Number>
Number parse(const std::string& word)
{
    const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    Number value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (stop != end || error != std::errc())
        throw std::invalid_argument("'" + word + "' is not a number of the kind expected");
    return value;
}

double parseDouble(const std::string& word)
{
    const double value = parse<double>(word);
    if (!std::isfinite(value)) throw std::invalid_argument("'" + word + "' is not finite");
    return value;
}

std::string text(double value)
{
    std::array<char, 40> buffer{};
    const auto result = std::to_chars(
        buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 17);
    return " " + std::string(buffer.data(), result.ptr);
}

std::string text(const Pose& T)
{
    Eigen::Quaterniond q(T.R);
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    std::string line;
    for (int i = 0; i < 3; i++) line += text(T.p[i]);
    for (int i = 0; i < 4; i++) line += text(q.coeffs()[i]);  // x y z w
    return line;
}

/** The upper triangle by rows. */
template <class Matrix>
std::string upperTriangle(const Matrix& m)
{
    std::string line;
    for (int i = 0; i < m.rows(); i++)
        for (int j = i; j < m.cols(); j++) line += text(m(i, j));
    return line;
}

std::string text(const RelativeEdge& e)
{
    const Matrix6d information =
        kToQuaternion.asDiagonal() * e.information * kToQuaternion.asDiagonal();
    return std::string(kEdge) + " " + std::to_string(e.from) + " " + std::to_string(e.to) +
           text(e.T_from_to) + upperTriangle(information);
}

std::string text(const GravityEdge& e)
{
    std::string line = std::string(kMark) + " gravity " + std::to_string(e.vertex);
    for (int i = 0; i < 3; i++) line += text(e.up_submap[i]);
    return line + upperTriangle(e.information);
}

/** Numbers from `words`, beginning with the given one. */
class Numbers
{
 public:
    Numbers(const Words& words, std::size_t first) : words_(words), next_(first) {}
    double next() { return parseDouble(words_[next_++]); }

    Vector3d vector()
    {
        Vector3d v;
        for (int i = 0; i < 3; i++) v[i] = next();
        return v;
    }

    /** Files with few decimals are not quite unit: 1 % is allowed, and taken away. */
    Pose pose()
    {
        Pose T;
        T.p = vector();
        Eigen::Quaterniond q;
        for (int i = 0; i < 4; i++) q.coeffs()[i] = next();
        if (!(std::abs(q.norm() - 1) < 0.01))
            throw std::invalid_argument("the quaternion is not of norm 1");
        T.R = q.normalized().toRotationMatrix();
        return T;
    }

    template <int N>
    Eigen::Matrix<double, N, N> symmetric()
    {
        Eigen::Matrix<double, N, N> m;
        for (int i = 0; i < N; i++)
            for (int j = i; j < N; j++) m(i, j) = m(j, i) = next();
        return m;
    }

 private:
    const Words& words_;
    std::size_t next_;
};

void expectWords(const Words& words, std::size_t number)
{
    if (words.size() != number)
        throw std::invalid_argument(
            std::to_string(number) + " words expected, found " + std::to_string(words.size()));
}

/** Builds a graph line by line. */
class Reader
{
 public:
    /** Throws std::invalid_argument with the cause. */
    void line(const Words& words)
    {
        const std::string& tag = words.front();
        if (tag == kMark)
            mark(words);
        else if (tag.front() == '#' || tag.rfind("PARAMS_", 0) == 0)
            return;
        else if (tag == kVertex)
            vertex(words);
        else if (tag == "FIX")
            fix(words);
        else if (tag == kEdge)
            edge(words, next_is_closure_, true);
        else
            throw std::invalid_argument("'" + tag + "' is no element of a 3-D pose graph");
    }

    /** Throws std::invalid_argument if something is missing. */
    PoseGraph finish()
    {
        if (next_is_closure_) throw std::invalid_argument("a loop closure is missing");
        if (marked_ && counts() != counts_)
            throw std::invalid_argument(
                "the file ends early: it should hold" + name(counts_) + ", and holds" +
                name(counts()));
        for (RelativeEdge& e : graph_.relative_edges)
            if (!marked_ && std::abs(e.to - e.from) != 1) e.kind = EdgeKind::LoopClosure;
        for (GraphVertex& v : graph_.vertices) v.fixed = fixed_.count(v.id) > 0;
        return std::move(graph_);
    }

 private:
    using Counts = std::array<std::size_t, 3>;

    Counts counts() const
    {
        return {graph_.vertices.size(), graph_.relative_edges.size(), graph_.gravity_edges.size()};
    }

    static std::string name(const Counts& c)
    {
        return " " + std::to_string(c[0]) + " vertices, " + std::to_string(c[1]) + " edges, " +
               std::to_string(c[2]) + " of gravity";
    }

    void mark(const Words& words)
    {
        const std::string what = words.size() > 1 ? words[1] : "";
        if (what == "graph")
        {
            expectWords(words, 5);
            for (std::size_t i = 0; i < 3; i++) counts_[i] = parse<std::size_t>(words[i + 2]);
            marked_ = true;
        }
        else if (what == "loop_closure" && words.size() == 2 && !next_is_closure_)
            next_is_closure_ = true;
        else if (what == "gravity")
            gravity(words);
        else if (what == "disabled" && words.size() > 3)
        {
            if (words[2] != "loop_closure" && words[2] != "odometry")
                throw std::invalid_argument("'" + words[2] + "' is no kind of edge");
            edge(Words(words.begin() + 3, words.end()), words[2] == "loop_closure", false);
        }
        else
            throw std::invalid_argument("a comment of taut that says nothing known");
    }

    void vertex(const Words& words)
    {
        expectWords(words, 9);
        GraphVertex v;
        v.id = parse<VertexId>(words[1]);
        if (!known_.insert(v.id).second)
            throw std::invalid_argument("vertex " + words[1] + " is given twice");
        v.T_world_submap = Numbers(words, 2).pose();
        graph_.vertices.push_back(v);
    }

    void fix(const Words& words)
    {
        if (words.size() < 2) throw std::invalid_argument("FIX names no vertex");
        for (std::size_t i = 1; i < words.size(); i++) fixed_.insert(knownVertex(words[i]));
    }

    void edge(const Words& words, bool closure, bool enabled)
    {
        if (words.front() != kEdge) throw std::invalid_argument("an edge expected");
        expectWords(words, 31);
        RelativeEdge e;
        e.from = knownVertex(words[1]);
        e.to = knownVertex(words[2]);
        Numbers numbers(words, 3);
        e.T_from_to = numbers.pose();
        const Vector6d scale = kToQuaternion.cwiseInverse();
        e.information = scale.asDiagonal() * numbers.symmetric<6>() * scale.asDiagonal();
        e.kind = closure ? EdgeKind::LoopClosure : EdgeKind::Odometry;
        e.enabled = enabled;
        checkEdge(e);
        graph_.relative_edges.push_back(e);
        if (enabled) next_is_closure_ = false;
    }

    void gravity(const Words& words)
    {
        expectWords(words, 12);
        GravityEdge e;
        e.vertex = knownVertex(words[2]);
        Numbers numbers(words, 3);
        e.up_submap = numbers.vector();
        e.information = numbers.symmetric<3>();
        checkEdge(e);
        graph_.gravity_edges.push_back(e);
    }

    VertexId knownVertex(const std::string& word) const
    {
        const auto id = parse<VertexId>(word);
        if (known_.count(id) == 0)
            throw std::invalid_argument("vertex " + word + " is not known here");
        return id;
    }

    PoseGraph graph_;
    std::set<VertexId> known_, fixed_;
    Counts counts_{};
    bool marked_ = false;
    bool next_is_closure_ = false;
};
}  // namespace

void writeG2o(const std::string& path, const PoseGraph& graph)
{
    const IndexedGraph check(graph);  // no file that nobody could read
    const std::string part = path + ".part";
    std::ofstream file(part);
    if (!file) throw writeError(part);
    file << kMark << " graph " << graph.vertices.size() << ' ' << graph.relative_edges.size() << ' '
         << graph.gravity_edges.size() << '\n';
    for (const GraphVertex& v : graph.vertices)
        file << kVertex << ' ' << std::to_string(v.id) << text(v.T_world_submap) << '\n';
    for (const GraphVertex& v : graph.vertices)
        if (v.fixed) file << "FIX " << std::to_string(v.id) << '\n';
    for (const RelativeEdge& e : graph.relative_edges)
    {
        const bool closure = e.kind == EdgeKind::LoopClosure;
        if (!e.enabled)
            file << kMark << " disabled " << (closure ? "loop_closure " : "odometry ");
        else if (closure)
            file << kMark << " loop_closure\n";
        file << text(e) << '\n';
    }
    for (const GravityEdge& e : graph.gravity_edges) file << text(e) << '\n';
    flushOrThrow(file, path);
    file.close();
    if (std::rename(part.c_str(), path.c_str()) != 0) throw writeError(path);
}

PoseGraph readG2o(const std::string& path)
{
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read '" + path + "'");
    Reader reader;
    std::size_t number = 0;
    try
    {
        for (std::string line; std::getline(file, line);)
        {
            number++;
            const Words words = wordsOf(line);
            if (!words.empty()) reader.line(words);
        }
        if (file.bad()) throw std::runtime_error("error while reading '" + path + "'");
        return reader.finish();
    }
    catch (const std::invalid_argument& e)
    {
        throw std::runtime_error(path + ":" + std::to_string(number) + ": " + e.what());
    }
}
}  // namespace taut
