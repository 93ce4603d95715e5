"""New unknowns in which a bundle's Jacobian is nearly orthonormal: LSMR needs a few steps where it took hundreds.

The normal matrix is [[B, E], [E^T, A]], B having a block of 6x6 for each board; its Cholesky factor L follows from
eliminating the boards (Triggs et al. 2000, section 6.1), and x = L^-T y.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import LinearOperator

Array = npt.NDArray[np.float64]

RIDGE = 1e-9
"""Of each diagonal entry, added: what no residual depends on stays where it is."""


class EliminatedScale:
    """x = L^-T y at a Jacobian.

    Args:
        J: (R, n) residuals by parameters.
        boards: The first so many parameters are boards, six each.
    """

    def __init__(self, J: csr_array, boards: int) -> None:
        assert boards % 6 == 0
        self.boards = boards
        (_, parameters) = J.shape  # pyright: ignore[reportGeneralTypeIssues]
        cameras = parameters - boards
        of_boards, of_cameras = csr_array(J[:, :boards]), csr_array(J[:, boards:])
        normal = of_boards.T @ of_boards
        floor = max(float(normal.diagonal().max(initial=0.0)) * 1e-12, 1e-12)
        blocks = np.zeros((boards // 6, 6, 6))
        near = (normal + diags_array(RIDGE * normal.diagonal() + floor)).tocoo()
        row, column = near.coords
        blocks[row // 6, row % 6, column % 6] = near.data
        self._back = np.linalg.inv(np.linalg.cholesky(blocks))
        mixed = (of_boards.T @ of_cameras).toarray().reshape(boards // 6, 6, cameras)
        self._mixed = self._back @ mixed
        rest = (of_cameras.T @ of_cameras).toarray()
        flat = self._mixed.reshape(boards, cameras)
        rest += np.diag(RIDGE * np.diag(rest) + floor)
        self._factor = cholesky(rest - flat.T @ flat + 1e-9 * np.diag(np.diag(rest)), lower=True) if len(rest) else rest

    @property
    def factor(self) -> Array:
        """(n, n) lower Cholesky factor of the normal equations of all but the boards, those eliminated."""
        return self._factor

    def apply(self, y: Array) -> Array:
        """x (n,) of y (n,)."""
        of_boards, of_cameras = y[: self.boards].reshape(-1, 6), y[self.boards :]
        if len(of_cameras):
            of_cameras = solve_triangular(self._factor, of_cameras, lower=True, trans=1)
        left = of_boards - self._mixed @ of_cameras
        return np.concatenate([np.einsum("bji,bj->bi", self._back, left).ravel(), of_cameras])

    def apply_transposed(self, x: Array) -> Array:
        """L^-1 x, (n,)."""
        of_boards = np.einsum("bij,bj->bi", self._back, x[: self.boards].reshape(-1, 6))
        of_cameras = x[self.boards :] - np.einsum("bin,bi->n", self._mixed, of_boards)
        if len(of_cameras):
            of_cameras = solve_triangular(self._factor, of_cameras, lower=True)
        return np.concatenate([of_boards.ravel(), of_cameras])

    def compose(self, J: csr_array) -> LinearOperator:
        """The Jacobian by y of the one by x (R, n)."""
        back = csr_array(J.T)
        return LinearOperator(
            dtype=np.float64,
            shape=J.shape,
            matvec=lambda y: J @ self.apply(np.ravel(y)),  # pyright: ignore[reportCallIssue]
            rmatvec=lambda r: self.apply_transposed(back @ np.ravel(r)),  # pyright: ignore[reportCallIssue]
        )
