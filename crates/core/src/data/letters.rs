//! Single letters as names of columns. What they mean depends on what stands beside them: `r` is a yaw rate
//! beside `u` and `v`, and a roll angle before `p` and `y`.

use crate::data::Channel;
use crate::data::spelling::{self, Meaning};

/// The channel of each column that is named by one of the letters `p`, `r`, `u`, `v` and the `y` of roll,
/// pitch and yaw; `Some(None)` is a letter that means nothing here, `None` any other column.
pub(super) fn channels(names: &[String]) -> Vec<Option<Option<Channel>>> {
    let letters: Vec<Option<char>> = names.iter().map(|name| letter(name)).collect();
    let has = |letter| letters.contains(&Some(letter));
    let names_any = |channels: &[Channel]| {
        let is = |name: &String| match spelling::meaning(name) {
            Meaning::Channel(channel, _) => channels.contains(&channel) && letter(name).is_none(),
            _ => false,
        };
        names.iter().any(is)
    };
    let has_velocities = has('u') && has('v') && !names_any(&[Channel::Vx, Channel::Vy]);
    let is_planar = has_velocities || names_any(&[Channel::Vx, Channel::Vy, Channel::Yaw]);
    let has_rates = has('q') || is_planar;
    let mut found: Vec<Option<Option<Channel>>> = letters
        .iter()
        .map(|letter| match letter {
            Some('r') => Some(has_rates.then_some(Channel::YawRate)),
            Some('p') => Some((has_rates && (has('r') || has('q'))).then_some(Channel::RollRate)),
            Some('u') => Some(has_velocities.then_some(Channel::Vx)),
            Some('v') => Some(has_velocities.then_some(Channel::Vy)),
            _ => None,
        })
        .collect();
    for at in 0..names.len().saturating_sub(2) {
        let is_y = |idx: usize| letters.get(idx) == Some(&Some('y'));
        let has_other_y = (0..at).any(is_y);
        let next = letters.get(at + 1).copied().flatten();
        let is_yaw = |idx: usize| {
            is_y(idx)
                || names.get(idx).is_some_and(|name| {
                    matches!(spelling::meaning(name), Meaning::Channel(Channel::Yaw, _))
                })
        };
        let (roll, yaw) = match (letters[at], next) {
            (Some('r'), Some('p')) if is_yaw(at + 2) => (at, at + 2),
            (_, Some('p')) if letters.get(at + 2) == Some(&Some('r')) => match is_y(at) {
                true if has_other_y => (at + 2, at),
                _ => continue,
            },
            _ => continue,
        };
        found[roll] = Some(Some(Channel::Roll));
        found[at + 1] = Some(None);
        found[yaw] = Some(Some(Channel::Yaw));
    }
    found
}

/// The letter that is the name of a column, perhaps with a unit.
fn letter(name: &str) -> Option<char> {
    let mut chars = name.trim().chars();
    let letter = chars.next().filter(|c| c.is_ascii_alphabetic())?;
    let is_alone = chars.next().is_none_or(|next| !next.is_alphanumeric());
    is_alone.then_some(letter.to_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_mean_what_stands_beside_them() {
        use Channel::{Roll, RollRate, Vx, Vy, Yaw, YawRate};
        let meant = |header: &str| {
            let names: Vec<String> = header.split(',').map(str::to_owned).collect();
            let found = channels(&names).into_iter().zip(names);
            let found = found.filter_map(|(channel, name)| Some((name, channel??)));
            found
                .map(|(name, channel)| format!("{name}={}", channel.short_name()))
                .collect::<Vec<_>>()
        };
        let expect = |header: &str, channels: &[(&str, Channel)]| {
            let expected: Vec<String> = channels
                .iter()
                .map(|(name, channel)| format!("{name}={}", channel.short_name()))
                .collect();
            assert_eq!(meant(header), expected, "{header}");
        };
        expect("time,x,y,z,r,p,y", &[("r", Roll), ("y", Yaw)]);
        expect("t,x,y,r [deg],p [deg],y [deg]", &[("r [deg]", Roll), ("y [deg]", Yaw)]);
        expect("t,x,y,r,p,yaw", &[("r", Roll), ("yaw", Yaw)]);
        expect("t,x,y,z,y,p,r", &[("y", Yaw), ("r", Roll)]);
        expect("t,u,v,r", &[("u", Vx), ("v", Vy), ("r", YawRate)]);
        expect("t,x,y,psi,r", &[("r", YawRate)]);
        expect("t,p,q,r", &[("p", RollRate), ("r", YawRate)]);
        expect("t,fx,fy,p", &[]);
        expect("t,x,y,r", &[]);
        expect("t,x,y,v", &[]);
    }
}
