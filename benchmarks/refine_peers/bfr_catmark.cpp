// Catmull-Clark limit points, unit normals and triangles of all faces by OpenSubdiv's Bfr, at one rate:
// bfr_catmark MESH RATE RUNS; prints triangles and milliseconds of the processor in the fastest run.
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <memory>
#include <vector>

using namespace OpenSubdiv;
using Surface = Bfr::Surface<double>;

struct Mesh {
    std::vector<double> positions;
    std::vector<int32_t> sizes, corners;
};

// int32 counts of vertices, faces, corners; positions; sizes of faces; corners.
static Mesh readMesh(char const *path) {
    FILE *file = std::fopen(path, "rb");
    int32_t counts[3];
    Mesh mesh;
    bool good = file && std::fread(counts, sizeof counts, 1, file) == 1;
    if (good) {
        mesh.positions.resize(3 * counts[0]);
        mesh.sizes.resize(counts[1]);
        mesh.corners.resize(counts[2]);
        good = std::fread(mesh.positions.data(), 8, mesh.positions.size(), file) == mesh.positions.size() &&
               std::fread(mesh.sizes.data(), 4, mesh.sizes.size(), file) == mesh.sizes.size() &&
               std::fread(mesh.corners.data(), 4, mesh.corners.size(), file) == mesh.corners.size();
    }
    if (!good) std::exit((std::fprintf(stderr, "%s cannot be read\n", path), 1));
    std::fclose(file);
    return mesh;
}

static double processorMs() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * now.tv_sec + 1e-6 * now.tv_nsec;
}

struct Output {
    std::vector<double> points, normals;
    std::vector<int> facets;
};

static long tessellate(Far::TopologyRefiner const &refiner, Mesh const &mesh, int rate, Output &out) {
    Bfr::RefinerSurfaceFactory<> surfaces(refiner);
    Surface surface;
    Surface::PointDescriptor triple(3);
    std::map<int, std::unique_ptr<Bfr::Tessellation>> patterns;  // a pattern for each number of corners
    std::map<int, std::vector<double>> coordinates;
    std::vector<double> patch;
    out.points.clear(), out.normals.clear(), out.facets.clear();
    for (size_t f = 0; f < mesh.sizes.size(); ++f) {
        if (!surfaces.InitVertexSurface(int(f), &surface)) continue;
        int sides = mesh.sizes[f];
        auto &pattern = patterns[sides];
        auto &uvs = coordinates[sides];
        if (!pattern) {
            pattern = std::make_unique<Bfr::Tessellation>(surface.GetParameterization(), rate);
            uvs.resize(2 * pattern->GetNumCoords());
            pattern->GetCoords(uvs.data());
        }
        patch.resize(3 * surface.GetNumPatchPoints());
        surface.PreparePatchPoints(mesh.positions.data(), triple, patch.data(), triple);
        size_t begin = out.points.size(), first = out.facets.size();
        int count = pattern->GetNumCoords();
        out.points.resize(begin + 3 * count);
        out.normals.resize(begin + 3 * count);
        for (int i = 0; i < count; ++i) {
            double u[3], v[3], *n = &out.normals[begin + 3 * i];
            surface.Evaluate(&uvs[2 * i], patch.data(), triple, &out.points[begin + 3 * i], u, v);
            n[0] = u[1] * v[2] - u[2] * v[1], n[1] = u[2] * v[0] - u[0] * v[2], n[2] = u[0] * v[1] - u[1] * v[0];
            double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (int k = 0; k < 3; ++k) n[k] /= length > 0 ? length : 1;
        }
        out.facets.resize(first + 3 * pattern->GetNumFacets());
        pattern->GetFacets(&out.facets[first]);
        pattern->TransformFacetCoordIndices(&out.facets[first], int(begin / 3));
    }
    return long(out.facets.size() / 3);
}

int main(int, char **words) {
    Mesh mesh = readMesh(words[1]);
    int rate = std::atoi(words[2]), runs = std::atoi(words[3]);
    Far::TopologyDescriptor described;
    described.numVertices = int(mesh.positions.size() / 3);
    described.numFaces = int(mesh.sizes.size());
    described.numVertsPerFace = mesh.sizes.data();
    described.vertIndicesPerFace = mesh.corners.data();
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(described, Factory::Options(Sdc::SCHEME_CATMARK, options)));
    Output out;
    long triangles = tessellate(*refiner, mesh, rate, out);  // warm, with room for all that comes
    double best = 1e30;
    for (int i = 0; i < runs; ++i) {
        double begin = processorMs();
        triangles = tessellate(*refiner, mesh, rate, out);
        best = std::min(best, processorMs() - begin);
    }
    std::printf("%ld %.4f\n", triangles, best);
}
