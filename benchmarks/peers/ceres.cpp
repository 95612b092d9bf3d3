// Ceres with automatic derivatives: the tasks of the benchmark on readings from a file, times as JSON.
// Usage: ceres READINGS ROWS SETS START.  READINGS: SETS times ROWS rows of 15 doubles (q, p, length). START: 27 doubles.
// Each set is one fit; the times are sums over the sets.
#include <ceres/ceres.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

struct Length {
    const double* row;
    template <typename T>
    static void tip(const T* x, const double* q, T* p) {
        p[0] = x[24]; p[1] = x[25]; p[2] = x[26];
        const double c6 = std::cos(q[6]), s6 = std::sin(q[6]);
        T turned = p[0] * c6 - p[1] * s6;
        p[1] = p[0] * s6 + p[1] * c6;
        p[0] = turned;
        for (int i = 5; i >= 0; --i) {
            const T ca = cos(x[4 * i + 1]), sa = sin(x[4 * i + 1]);
            const T px = p[0] + x[4 * i + 2], py = ca * p[1] - sa * p[2];
            p[2] = sa * p[1] + ca * p[2] + x[4 * i + 3];
            const T c = cos(q[i] - x[4 * i]), s = sin(q[i] - x[4 * i]);
            p[0] = c * px - s * py;
            p[1] = s * px + c * py;
        }
    }
    template <typename T>
    bool operator()(const T* x, T* residual) const {
        T p[3], q[3];
        tip(x, row, p);
        tip(x, row + 7, q);
        const T dx = p[0] - q[0], dy = p[1] - q[1], dz = p[2] - q[2];
        residual[0] = sqrt(dx * dx + dy * dy + dz * dz) - row[14];
        return true;
    }
};
using Cost = ceres::AutoDiffCostFunction<Length, 1, 27>;
using Clock = std::chrono::steady_clock;

static double seconds(Clock::time_point since) {
    return std::chrono::duration<double>(Clock::now() - since).count();
}

static std::vector<double> read(const char* path, size_t count) {
    std::vector<double> values(count);
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(values.data()), count * sizeof(double));
    return values;
}

int main(int, char** argv) {
    const size_t rows = std::stoul(argv[2]), sets = std::stoul(argv[3]);
    const std::vector<double> data = read(argv[1], rows * sets * 15), start = read(argv[4], 27);

    double sum = 0.0;
    auto since = Clock::now();
    for (size_t i = 0; i < rows; ++i) {
        double p[3];
        Length::tip(start.data(), &data[15 * i], p);
        sum += p[0] + p[1] + p[2];
    }
    const double forward = seconds(since);

    double residual_jacobian = 0.0, fit = 0.0;
    std::vector<double> x;
    for (size_t set = 0; set < sets; ++set) {
        const double* block = &data[15 * rows * set];
        x = start;
        since = Clock::now();
        ceres::Problem problem;
        std::vector<Cost*> costs;
        for (size_t i = 0; i < rows; ++i) costs.push_back(new Cost(new Length{block + 15 * i}));
        for (Cost* cost : costs) problem.AddResidualBlock(cost, nullptr, x.data());
        problem.SetManifold(x.data(), new ceres::SubsetManifold(27, {0, 3}));
        ceres::Solver::Options options;
        options.linear_solver_type = rows > 1000 ? ceres::DENSE_NORMAL_CHOLESKY : ceres::DENSE_QR;
        options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-14;
        options.num_threads = 1;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
        fit += seconds(since);

        since = Clock::now();
        for (const Cost* cost : costs) {
            double residual, gradient[27];
            const double* blocks[1] = {start.data()};
            double* gradients[1] = {gradient};
            cost->Evaluate(blocks, &residual, gradients);
            sum += residual + gradient[0];
        }
        residual_jacobian += seconds(since);
    }
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);

    std::printf("{\"version\": \"%s\", \"forward_s\": %.9g, \"residual_jacobian_s\": %.9g, \"fit_s\": %.9g, ",
                CERES_VERSION_STRING, forward, residual_jacobian, fit);
    std::printf("\"peak_kb\": %ld, \"sum\": %g, \"x\": [", usage.ru_maxrss, sum);
    for (int k = 0; k < 27; ++k) std::printf("%s%.17g", k ? ", " : "", x[k]);
    std::printf("]}\n");
}
