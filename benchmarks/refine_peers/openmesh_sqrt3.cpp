// Adaptive √3 subdivision by OpenMesh: openmesh_sqrt3 MESH EYE_X EYE_Y EYE_Z PIXELS_PER_RADIAN EDGE_PIXELS
#define _USE_MATH_DEFINES
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Adaptive/Composite/CompositeT.hh>
#include <OpenMesh/Tools/Subdivider/Adaptive/Composite/RulesT.hh>

#include "peer.h"

namespace Adaptive = OpenMesh::Subdivider::Adaptive;

struct Traits : Adaptive::CompositeTraits {
    typedef OpenMesh::Vec3d Point;
    typedef OpenMesh::Vec3d Normal;
};
typedef OpenMesh::TriMesh_ArrayKernelT<Traits> Net;

static bool isWanted(Net const &net, View const &view, Net::FaceHandle f) {
    Net::Point p[3];
    int k = 0;
    for (auto v = net.cfv_iter(f); v.is_valid() && k < 3; ++v) p[k++] = net.point(*v);
    if (!view.faces(p[0], p[1], p[2])) return false;
    return view.excess(p[0], p[1]) > 1 || view.excess(p[1], p[2]) > 1 || view.excess(p[2], p[0]) > 1;
}

int main(int, char **words) {
    Mesh mesh = readMesh(words[1]);
    View view = View::of(words + 2);
    return report([&] {
        Net net;
        std::vector<Net::VertexHandle> vertices;
        for (int v = 0; v < mesh.vertexCount(); ++v)
            vertices.push_back(net.add_vertex(Net::Point(&mesh.positions[3 * v])));
        for (int f = 0; f < mesh.faceCount(); ++f)
            net.add_face(vertices[mesh.faces[3 * f]], vertices[mesh.faces[3 * f + 1]], vertices[mesh.faces[3 * f + 2]]);
        Adaptive::CompositeT<Net> subdivider(net);
        subdivider.add<Adaptive::Tvv3<Net>>();
        subdivider.add<Adaptive::VF<Net>>();
        subdivider.add<Adaptive::FF<Net>>();
        subdivider.add<Adaptive::FVc<Net>>();
        subdivider.initialize();
        for (bool isDone = false; !isDone;) {
            isDone = true;
            size_t count = net.n_faces();
            for (size_t i = 0; i < count; ++i) {
                // Asked for just before, since what was done to a neighbour may have refined it already.
                Net::FaceHandle f = net.face_handle(int(i));
                if (!isWanted(net, view, f)) continue;
                subdivider.refine(f);
                isDone = false;
            }
        }
        return long(net.n_faces());
    });
}
