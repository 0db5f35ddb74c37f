//! Cycles of a directed graph.

/// The strongly connected components in topological order (a component comes after all its predecessors), each ascending.
///
/// Source: Kosaraju's algorithm as in Aho, Hopcroft & Ullman, *Data Structures and Algorithms*, 1983, §6.7.
pub(crate) fn components(successors: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let nodes = successors.len();
    let mut predecessors = vec![Vec::new(); nodes];
    for (from, next) in successors.iter().enumerate() {
        for to in next {
            predecessors[*to].push(from);
        }
    }
    let mut visited = vec![false; nodes];
    let mut finished = Vec::with_capacity(nodes);
    for root in 0..nodes {
        depth_first(root, successors, &mut visited, &mut finished);
    }
    let mut visited = vec![false; nodes];
    let mut found = Vec::new();
    for root in finished.into_iter().rev() {
        let mut component = Vec::new();
        depth_first(root, &predecessors, &mut visited, &mut component);
        if !component.is_empty() {
            component.sort_unstable();
            found.push(component);
        }
    }
    found
}

/// True if a component is a cycle: it has several nodes, or an edge to itself.
pub(crate) fn is_cycle(component: &[usize], successors: &[Vec<usize>]) -> bool {
    component.len() > 1 || component.iter().any(|node| successors[*node].contains(node))
}

/// The nodes of a shortest cycle through the first node of a component.
pub(crate) fn shortest_way_round(component: &[usize], successors: &[Vec<usize>]) -> Vec<usize> {
    let start = component[0];
    let mut before = vec![None; successors.len()];
    let mut queue = std::collections::VecDeque::from([start]);
    while let Some(node) = queue.pop_front() {
        for next in successors[node].iter().filter(|next| component.contains(next)) {
            if *next == start {
                let mut way = vec![node];
                while let Some(previous) = before[way[way.len() - 1]] {
                    way.push(previous);
                }
                way.reverse();
                return way;
            }
            if before[*next].is_none() {
                before[*next] = Some(node);
                queue.push_back(*next);
            }
        }
    }
    component.to_vec()
}

/// Appends the nodes that are reachable from `root` and not yet visited, each after all its successors.
fn depth_first(root: usize, next: &[Vec<usize>], visited: &mut [bool], finished: &mut Vec<usize>) {
    if std::mem::replace(&mut visited[root], true) {
        return;
    }
    let mut stack = vec![(root, 0)];
    while let Some((node, edge)) = stack.last_mut() {
        if let Some(to) = next[*node].get(*edge) {
            *edge += 1;
            if !std::mem::replace(&mut visited[*to], true) {
                stack.push((*to, 0));
            }
        } else {
            finished.push(*node);
            stack.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Oracle: the transitive closure by Warshall's algorithm.
    fn reaches(successors: &[Vec<usize>]) -> Vec<Vec<bool>> {
        let nodes = successors.len();
        let mut closure: Vec<Vec<bool>> =
            successors.iter().map(|next| (0..nodes).map(|to| next.contains(&to)).collect()).collect();
        for via in 0..nodes {
            for from in 0..nodes {
                for to in 0..nodes {
                    closure[from][to] |= closure[from][via] && closure[via][to];
                }
            }
        }
        closure
    }

    proptest! {
        #[test]
        fn nodes_share_a_component_when_each_reaches_the_other(
            successors in proptest::collection::vec(proptest::collection::vec(0_usize..7, 0..3), 7)
        ) {
            let (closure, found) = (reaches(&successors), components(&successors));
            let place = |node| found.iter().position(|component| component.contains(&node)).unwrap();
            for from in 0..7 {
                prop_assert_eq!(closure[from][from], is_cycle(&found[place(from)], &successors));
                for (to, reached) in closure[from].iter().enumerate() {
                    let mutual = from == to || *reached && closure[to][from];
                    prop_assert_eq!(place(from) == place(to), mutual);
                    prop_assert!(!reached || place(from) <= place(to), "order of {} and {}", from, to);
                }
            }
            for component in found.iter().filter(|component| is_cycle(component, &successors)) {
                let way = shortest_way_round(component, &successors);
                for (from, to) in way.iter().zip(way.iter().cycle().skip(1)) {
                    prop_assert!(successors[*from].contains(to), "{:?} in {:?}", way, successors);
                }
            }
        }
    }
}
