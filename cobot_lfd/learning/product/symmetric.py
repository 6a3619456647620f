"""Batches of small symmetric matrices, stored as their upper triangles.

A symmetric d x d matrix is kept as its v = d (d + 1) / 2 distinct entries, in the order of
``np.triu_indices(d)``; the entry axis comes before the time axis, so that a batch of rotations is one matrix
product and the solution of many small systems is a handful of operations on long arrays.
"""

from functools import cache

import numpy as np

from cobot_lfd.arrays import Array


@cache
def _pairs(d: int) -> tuple[tuple[int, int], ...]:
    """The index pairs of the stored entries."""
    rows, columns = np.triu_indices(d)
    return tuple(zip(rows.tolist(), columns.tolist(), strict=True))


@cache
def entry(d: int, i: int, j: int) -> int:
    """Where entry (i, j) of a symmetric d x d matrix is stored."""
    return _pairs(d).index((min(i, j), max(i, j)))


def pack(matrices: Array) -> Array:
    """Symmetric matrices, shape (..., T, d, d), to their entries, shape (..., v, T)."""
    rows, columns = np.triu_indices(matrices.shape[-1])
    return np.moveaxis(matrices[..., rows, columns], -1, -2)


def unpack(entries: Array, d: int) -> Array:
    """Entries, shape (..., v, T), to symmetric matrices, shape (..., T, d, d)."""
    where = np.array([[entry(d, i, j) for j in range(d)] for i in range(d)])
    return np.moveaxis(entries, -2, -1)[..., where]


def rotation_map(rotations: Array) -> Array:
    """The linear map that turns the entries of P into those of R P R', shape (..., v, v)."""
    d = rotations.shape[-1]
    pairs = _pairs(d)
    out = np.empty((*rotations.shape[:-2], len(pairs), len(pairs)))
    for row, (i, j) in enumerate(pairs):
        for column, (k, m) in enumerate(pairs):
            product = rotations[..., i, k] * rotations[..., j, m]
            if k != m:
                product = product + rotations[..., i, m] * rotations[..., j, k]
            out[..., row, column] = product
    return out


def times_vector(entries: Array, vectors: Array) -> Array:
    """Matrix times vector: entries (..., v, T), vectors (..., d, T) or (..., d, 1) -> (..., d, T)."""
    d = vectors.shape[-2]
    rows = [sum(entries[..., entry(d, i, j), :] * vectors[..., j, :] for j in range(d)) for i in range(d)]
    return np.stack(rows, axis=-2)


def inverse(entries: Array, d: int) -> Array:
    """The inverses' entries, by cofactors (d up to 3), shape (..., v, T)."""
    e = [[entries[..., entry(d, i, j), :] for j in range(d)] for i in range(d)]
    if d == 1:
        return 1.0 / entries
    if d == 2:
        determinant = e[0][0] * e[1][1] - e[0][1] ** 2
        return np.stack([e[1][1], -e[0][1], e[0][0]], axis=-2) / determinant[..., None, :]
    cofactors = [_cofactor(e, i, j) for i, j in _pairs(3)]
    determinant = e[0][0] * cofactors[0] + e[0][1] * cofactors[1] + e[0][2] * cofactors[2]
    return np.stack(cofactors, axis=-2) / determinant[..., None, :]


def _cofactor(e: list[list[Array]], i: int, j: int) -> Array:
    """Cofactor (i, j) of a 3 x 3 matrix of arrays."""
    (a, b), (c, d) = [k for k in range(3) if k != i], [k for k in range(3) if k != j]
    return np.asarray((-1) ** (i + j) * (e[a][c] * e[b][d] - e[a][d] * e[b][c]))
