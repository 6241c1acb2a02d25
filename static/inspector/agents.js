// Groups a state's tree of `parts` by agent.

/** Returns the paths of the parts of a kind, in the order of the tree. */
export const pathsOf = (parts, kind) => Object.keys(parts ?? {}).filter((path) => parts[path].is === kind);

/** Returns the paths of the production systems. */
export const systemsOf = (parts) => pathsOf(parts, "system");

/** Returns the names of the productions of all systems, each once. */
export const productionNames = (parts) => [...new Set(systemsOf(parts).flatMap((path) => parts[path].productions))];

/** Returns a text that identifies a production among those of all systems. */
export const productionKey = (system, name) => `${system}\n${name}`;

/** Whether a part is below another in the tree; the first run's top model is `top`, which is omitted from its parts' paths. */
export function isBelow(path, above) {
  return path !== above && (path.startsWith(`${above}.`) || (above === "top" && !path.startsWith("top#")));
}

/** Returns the agents: the production systems that are not inside another one. */
export function agentsOf(parts) {
  const systems = systemsOf(parts);
  return systems.filter((path) => !systems.some((other) => isBelow(path, other)));
}

/** Returns the agent that a part belongs to, or null. */
export function agentOf(path, agents) {
  return agents.find((agent) => agent === path || isBelow(path, agent)) ?? null;
}

/** Returns the name of a part relative to its agent. */
export function nameIn(agent, path) {
  return agent && path.startsWith(`${agent}.`) ? path.slice(agent.length + 1) : path;
}

/** Returns the number of the run of a program that a part belongs to, counted from 1. */
export function runOf(path) {
  return Number(/^top#(\d+)/.exec(path)?.[1] ?? 1);
}
