// Uniform Loop subdivision by OpenSubdiv's Far: far_loop MESH LEVELS
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <memory>

#include "peer.h"

using namespace OpenSubdiv;

struct Point {
    double at[3];
    void Clear() { at[0] = at[1] = at[2] = 0; }
    void AddWithWeight(Point const &p, double w) {
        for (int i = 0; i < 3; ++i) at[i] += w * p.at[i];
    }
};

int main(int, char **words) {
    Mesh mesh = readMesh(words[1]);
    int levels = std::atoi(words[2]);
    return report([&] {
        Far::TopologyDescriptor described;
        std::vector<int> sizes(mesh.faceCount(), 3);
        described.numVertices = mesh.vertexCount();
        described.numFaces = mesh.faceCount();
        described.numVertsPerFace = sizes.data();
        described.vertIndicesPerFace = mesh.faces.data();
        using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        std::unique_ptr<Far::TopologyRefiner> refiner(
            Factory::Create(described, Factory::Options(Sdc::SCHEME_LOOP, options)));
        refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(levels));
        std::vector<Point> points(refiner->GetNumVerticesTotal());
        for (int v = 0; v < mesh.vertexCount(); ++v)
            for (int i = 0; i < 3; ++i) points[v].at[i] = mesh.positions[3 * v + i];
        Far::PrimvarRefinerReal<double> interpolation(*refiner);
        Point *level = points.data();
        for (int l = 1; l <= levels; ++l) {
            Point *finer = level + refiner->GetLevel(l - 1).GetNumVertices();
            interpolation.Interpolate(l, level, finer);
            level = finer;
        }
        auto last = refiner->GetLevel(levels);
        std::vector<int> faces(3 * size_t(last.GetNumFaces()));
        for (int f = 0; f < last.GetNumFaces(); ++f) {
            auto corners = last.GetFaceVertices(f);
            for (int k = 0; k < 3; ++k) faces[3 * size_t(f) + k] = corners[k];
        }
        return long(faces.size() / 3);
    });
}
