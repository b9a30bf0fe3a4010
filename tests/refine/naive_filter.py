"""View-dependent √3 refinement as the paper tells it: lists and dictionaries, each step after the other."""

import math

import numpy as np

FRONT, SILHOUETTE, BACK = range(3)


def in_frustum(positions, face, camera):
    """(may be seen, is wholly inside)."""
    corners = np.concatenate([positions[face], np.ones((3, 1))], axis=1)
    inside = corners @ camera.frustum().T >= 0  # corners by planes
    return bool(inside.any(axis=0).all()), bool(inside.all())


def is_front(positions, face, camera):
    a, b, c = positions[face]
    return float(np.cross(b - a, c - a) @ (camera.position - a)) > 0


def sides(faces):
    """Of each directed edge the face that has it."""
    return {(f[k], f[(k + 1) % 3]): i for i, f in enumerate(faces) for k in range(3)}


def silhouette(positions, faces, seeds, camera):
    """The faces at an end of an edge between a front face of `seeds` and one that is not front."""
    owner, ends = sides(faces), set()
    for i in seeds:
        f = faces[i]
        if is_front(positions, f, camera):
            for k in range(3):
                beyond = owner.get((f[(k + 1) % 3], f[k]))
                if beyond is not None and not is_front(positions, faces[beyond], camera):
                    ends |= {f[k], f[(k + 1) % 3]}
    return {i for i, f in enumerate(faces) if ends & set(f)}


def is_coarse(positions, faces, i, camera, region, iteration):
    corners = positions[faces[i]]
    longest = max(np.linalg.norm(corners[k] - corners[k - 1]) for k in range(3))
    away = np.linalg.norm(camera.position - corners.mean(axis=0))
    if iteration >= region.iterations:
        return False
    if region.edge_px and camera.pixels_per_radian() * longest / away <= region.edge_px:
        return False
    return not region.bend or bend(positions, faces, i) >= region.bend


def bend(positions, faces, i):
    """The largest angle between the normals of a face and of those beside it."""
    owner, f = sides(faces), faces[i]
    beside = [owner[e] for e in ((f[(k + 1) % 3], f[k]) for k in range(3)) if e in owner]
    normals = [np.cross(*(positions[faces[j][1:]] - positions[faces[j][0]])) for j in (i, *beside)]
    normals = [n / np.linalg.norm(n) for n in normals]
    return max((math.acos(min(1, max(-1, float(normals[0] @ n)))) for n in normals[1:]), default=0.0)


def refined(positions, faces, camera, criteria, budget=10**9):
    """The mesh after each step as (positions, faces), the control mesh first."""
    positions, faces = np.array(positions), [list(map(int, f)) for f in faces]
    states = [(positions.copy(), [f[:] for f in faces])]
    # Of each part of what was split last: is it to be refined as front or back, may it have a silhouette,
    # is it wholly in the frustum, which way does it face (None: to be tested).
    parts = {i: [True, True, False, None] for i in range(len(faces))}
    for iteration in range(99):
        chosen, parts = choose(positions, faces, parts, camera, criteria, iteration)
        allowed = max((budget - len(faces)) // 2, 0)
        if not chosen[:allowed]:
            break
        is_done = len(chosen) <= allowed
        chosen = chosen[:allowed]
        moved = filtered(positions, faces, chosen, iteration % 2 == 1)
        positions, thirds = split(positions, faces, chosen, iteration % 2 == 1, parts)
        states.append((positions.copy(), [f[:] for f in faces]))
        for v, p in moved.items():
            positions[v] = p
        states.append((positions.copy(), [f[:] for f in faces]))
        swap(faces, thirds, parts)
        states.append((positions.copy(), [f[:] for f in faces]))
        if not is_done:
            break
    return states


def choose(positions, faces, parts, camera, criteria, iteration):
    """(faces to split, silhouettes first; {face: flags of its thirds})."""
    seen = {}
    for i, (is_area, is_seed, is_inside, front) in parts.items():
        may, whole = (True, True) if is_inside else in_frustum(positions, faces[i], camera)
        if may:
            front = is_front(positions, faces[i], camera) if front is None else front
            seen[i] = (is_area, is_seed, whole, front)
    seeds = [i for i in seen if seen[i][1] and iteration < criteria.silhouette.iterations]
    strip = silhouette(positions, faces, seeds, camera)
    fine = {i for i in strip if is_coarse(positions, faces, i, camera, criteria.silhouette, iteration)}
    area = []
    for i, (is_area, _, _, front) in seen.items():
        region = criteria.front if front else criteria.back
        if is_area and is_coarse(positions, faces, i, camera, region, iteration):
            area.append(i)
    chosen = sorted(fine) + sorted(set(area) - fine)
    flags = {}
    for i in chosen:
        whole, front = seen[i][2:] if i in seen else (False, None)
        is_off = i not in strip and (i in seeds or parts[i][3] is not None)
        flags[i] = [i in area, i in fine, whole, front if is_off else None]
    return chosen, flags


def filtered(positions, faces, chosen, is_odd):
    """{vertex: where it goes} of the corners of chosen faces."""
    owner = sides(faces)
    following = {a: b for a, b in owner if (b, a) not in owner}
    before = {b: a for a, b in following.items()}
    moved = {}
    for v in {v for i in chosen for v in faces[i]}:
        ring = sorted({w for f in faces if v in f for w in f} - {v})
        if v not in following:
            n = len(ring)
            share = (4 - 2 * math.cos(2 * math.pi / n)) / 9
            moved[v] = (1 - share) * positions[v] + share * positions[ring].mean(axis=0)
        elif is_odd:
            ends = positions[before[v]] + positions[following[v]]
            moved[v] = (4 * ends + 19 * positions[v]) / 27
    return moved


def split(positions, faces, chosen, is_odd, parts):
    """(positions, the faces whose edge 0 is an old one); `faces` and `parts` grow."""
    owner = sides(faces)
    following = {a: b for a, b in owner if (b, a) not in owner}
    before = {b: a for a, b in following.items()}
    new, thirds = [], []
    for i in chosen:
        f = faces[i]
        v, m = len(positions) + len(new), len(faces)
        borders = [k for k in range(3) if (f[(k + 1) % 3], f[k]) not in owner]
        if is_odd and len(borders) == 1:
            k = borders[0]
            a, b, c = f[k:] + f[:k]
            pa, pb = positions[a], positions[b]
            new.append((positions[before[a]] + 16 * pa + 10 * pb) / 27)
            new.append((10 * pa + 16 * pb + positions[following[b]]) / 27)
            f[k], f[(k + 1) % 3] = v, v + 1
            faces += [[c, a, v], [b, c, v + 1]]
            thirds += [m, m + 1]
        else:
            a, b, c = f
            new.append(positions[f].sum(axis=0) / 3)
            f[2] = v
            faces += [[c, a, v], [b, c, v]]
            thirds += [i, m, m + 1]
        parts[m], parts[m + 1] = parts[i][:], parts[i][:]
    return np.concatenate([positions, np.array(new)]), thirds


def swap(faces, thirds, parts):
    done = set()
    for i in thirds:
        if i in done:
            continue
        done.add(i)
        a, b, v = faces[i]
        owner = sides(faces)
        n = owner.get((b, a))
        if n is None:
            continue
        k = faces[n].index(b)
        d = faces[n][(k + 2) % 3]
        if d == v or (v, d) in owner or (d, v) in owner:
            continue
        faces[i][0], faces[n][k] = d, v
        done.add(n)
        one, two = parts.get(i), parts.get(n)
        is_inside = bool(two) and one[2] and two[2]
        front = one[3] if two and one[3] == two[3] else None
        for part in (one, two):
            if part:
                part[2], part[3] = is_inside, front
