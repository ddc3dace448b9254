"""A one-dimensional depth buffer: the nearest thing of each beam, as the inverse of its range.

Along one straight wall the inverse range is A cos(angle) + B sin(angle), so a wall is put into
the buffer with a multiplication and a maximum per beam that meets it. The buffer is the last row
of a *fan*, float32 [3, beams and spare ones]; above it stand the beams' cosines and sines.
"""

from __future__ import annotations

from typing import Any, Final

import llvmlite.ir as ir
import numpy as np
from numba import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from roomba.compilation import any_order_part

LANES: Final = 16
"""Beams that are worked on at once; buffers have so many spare places at their end."""


COSINE, SINE, NEAREST = range(3)
"""Rows of a fan."""


def _block(typing_context: Any, fan: Any, target: Any, source: Any, count: Any, factor: Any) -> Any:
    """Raise LANES numbers of a fan from ``target`` on to ``factor`` times those from ``source`` on.

    Only the first ``count`` of them are raised. This is written as vector code: LLVM does not
    vectorize spans of some ten beams, and one by one they take three times as long as all else in a
    scan.
    """
    signature = types.void(fan, types.int64, types.int64, types.int64, types.float32)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        floats = ir.VectorType(ir.FloatType(), LANES)
        integers = ir.VectorType(ir.IntType(32), LANES)

        array = context.make_array(signature.args[0])(context, builder, arguments[0])

        def place(offset: Any) -> Any:
            return builder.bitcast(builder.gep(array.data, [offset]), floats.as_pointer())

        def in_all_lanes(value: Any, vector: Any) -> Any:
            undefined = ir.Constant(vector, ir.Undefined)
            single = builder.insert_element(undefined, value, ir.Constant(ir.IntType(32), 0))
            return builder.shuffle_vector(single, undefined, ir.Constant(integers, [0] * LANES))

        target = place(arguments[1])
        before = builder.load(target, align=4)
        table = builder.load(place(arguments[2]), align=4)
        wall = builder.fmul(table, in_all_lanes(arguments[4], floats))
        lanes = ir.Constant(integers, list(range(LANES)))
        last = builder.trunc(arguments[3], ir.IntType(32))
        counts = builder.icmp_signed("<", lanes, in_all_lanes(last, integers))
        nearer = builder.and_(counts, builder.fcmp_ordered(">", wall, before))
        builder.store(builder.select(nearer, wall, before), target, align=4)
        return context.get_dummy_value()

    return signature, generate


_raise_block: Any = intrinsic(_block)


@any_order_part
def raise_span(
    fan: NDArray[np.float32], table: int, first: int, last: int, factor: np.float32
) -> None:
    """Raise the depth buffer to ``factor`` times a row of the fan, from beam ``first`` to ``last``.

    The fan has :data:`LANES` columns more than any beam that counts.
    """
    size = fan.shape[1]
    while first <= last:
        _raise_block(fan, NEAREST * size + first, table * size + first, last + 1 - first, factor)
        first += LANES


@any_order_part
def shows_through(
    fan: NDArray[np.float32], table: int, first: int, last: int, factor: np.float32
) -> bool:
    """Tell whether any beam of a span reaches a line, ``factor`` times a row, past what is near."""
    for beam in range(first, last + 1):  # noqa: SIM110 (a generator would be an object)
        if fan[table, beam] * factor > fan[NEAREST, beam]:
            return True
    return False
