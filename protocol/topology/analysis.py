"""What a graph can do: its Laplacian, how fast it agrees, and whether the gains of a consensus law fit it.

Rules: how many eigenvalues are zero is counted on the graph, not guessed from rounding; numpy and networkx are
loaded when they are needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt
from typing import TYPE_CHECKING

from protocol.topology.graph import Graph

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Analysis:
    """What there is to know about a graph."""

    robots: int
    directed: bool  # some a_ij differs from a_ji
    eigenvalues: tuple[complex, ...]  # of L (3.1), ascending real parts; the imaginary parts are 0 if not directed
    zeros: int  # how many of them are 0
    lambda_2: float | None  # second smallest real part; of an undirected graph the algebraic connectivity; None: N = 1
    connected: bool  # the physical links hang together
    spanning_tree: bool  # some robot is heard, over others, by all (Lemma 2); of an undirected graph: connected

    @property
    def nonzero(self) -> tuple[complex, ...]:
        """mu_i: the nonzero eigenvalues."""
        return self.eigenvalues[self.zeros :]


@dataclass(frozen=True, slots=True)
class Condition:
    """Condition (5.2) for one pair of gains."""

    beta: float
    gamma: float
    bound: float  # gamma must be greater than this; 0 when there is no nonzero eigenvalue
    undirected: bool
    connected: bool

    @property
    def holds(self) -> bool:
        """Whether Proposition 8 may be called upon: an undirected, connected graph and gamma beyond the bound."""
        return self.undirected and self.connected and self.gamma > self.bound


def laplacian(graph: Graph) -> NDArray[np.float64]:
    """The graph Laplacian.

    Thesis section 3.2, eq. (3.1):  l_ii = sum_j a_ij,  l_ij = -a_ij

    Returns: L, (N, N); its rows add up to 0.
    """
    import numpy as np

    a = np.array(graph.adjacency(), dtype=np.float64).reshape(graph.robots, graph.robots)
    result: NDArray[np.float64] = np.diag(a.sum(axis=1)) - a
    return result


def analyse(graph: Graph) -> Analysis:
    """Eigenvalues, connectivity and spanning tree of `graph`."""
    import networkx as nx
    import numpy as np

    ell = laplacian(graph)
    undirected = graph.is_symmetric()
    values = np.linalg.eigvalsh(ell).astype(complex) if undirected else np.linalg.eigvals(ell)
    listens = graph.to_networkx()
    # A group that listens to nobody outside agrees on its own: each such group adds one zero eigenvalue.
    groups = nx.condensation(listens)
    closed = sum(1 for _, out in groups.out_degree() if out == 0)
    order = np.lexsort((values.imag, np.round(values.real, 12)))
    smallest_first = [complex(value) for value in values[order]]
    eigenvalues = (*[0j] * closed, *_without_zeros(smallest_first, closed))
    return Analysis(
        robots=graph.robots,
        directed=not undirected,
        eigenvalues=eigenvalues,
        zeros=closed,
        lambda_2=eigenvalues[1].real if graph.robots > 1 else None,
        connected=nx.is_weakly_connected(listens),
        spanning_tree=closed == 1,
    )


def gain_condition(analysis: Analysis, beta: float, gamma: float) -> Condition:
    """Whether the gains of the consensus laws (5.1)-(5.7) fit the graph.

    Thesis section 5.2.2, eq. (5.2):  gamma > max_i sqrt(4 beta / (3 mu_i)),  mu_i the nonzero eigenvalues of L

    Args:
        beta: position gain, 1/s^2, > 0.
        gamma: velocity gain, 1/s, > 0.
    Returns: the verdict and the bound that gamma must exceed.
    Holds when: the graph is undirected and connected (Proposition 8). For a directed graph the bound is computed from
        the real parts, for orientation only.
    Departs from the thesis: Proposition 8 calls the convergence finite-time; its tail is exponential.
    """
    mus = [value.real for value in analysis.nonzero]
    bound = max((sqrt(4.0 * beta / (3.0 * mu)) if mu > 0 else inf for mu in mus), default=0.0)
    return Condition(beta, gamma, bound, not analysis.directed, analysis.connected)


def _without_zeros(values: list[complex], zeros: int) -> list[complex]:
    """`values` without the `zeros` nearest to 0."""
    dropped = set(sorted(range(len(values)), key=lambda n: abs(values[n]))[:zeros])
    return [value for n, value in enumerate(values) if n not in dropped]
